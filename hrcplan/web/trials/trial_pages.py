"""What participants see, besides the collaboration itself: forms without scripts."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from hrcplan.web.pages import SCRIPT, card, document
from hrcplan.web.trials.participants import Participant
from hrcplan.web.trials.study_file import CHOICE, SCALE, FormQuestion, TrialStudy

MAX_TEXT = 4000  # characters of an answer
_STORED = (
    "<p>What is stored: your answers, and what you and the robot do in the tasks, with a number "
    "and the time within the task. No name, no address of your computer. It is stored for {days} "
    "days at most. You can stop at any time, and delete everything with <b>your own link</b>, "
    "which you get on the next page.</p>"
)


def arrival_page(study: TrialStudy) -> str:
    """Return the page behind the invitation: what the study is, and consent."""
    body = (
        f"{_paragraphs(study.consent)}{_STORED.format(days=study.keep_days)}"
        '<form method="post"><p><label><input type="checkbox" name="agree" value="yes" required> '
        "I have read this, and agree to take part.</label></p>"
        '<p><button class="main">begin</button></p></form>'
    )
    return _page(study, card("Consent", body))


def consent_page(study: TrialStudy, person: Participant) -> str:
    """Return the page with the participant's own link."""
    body = (
        "<p>Thank you. This page is <b>your own link</b>: keep it to go on later, also on another "
        "device, or to delete your data.</p>" + next_form("go on")
    )
    return _page(study, card(f"Participant {person.number + 1}", body) + _delete_link(person))


def instructions_page(study: TrialStudy, person: Participant) -> str:
    """Return the page that says what to do."""
    body = _paragraphs(study.instructions) + next_form("begin the first task")
    return _page(study, card("What to do", body) + _delete_link(person))


def questions_page(
    study: TrialStudy, person: Participant, questions: Sequence[FormQuestion]
) -> str:
    """Return a questionnaire."""
    fields = "".join(map(_field, questions))
    button = '<p><button class="main">go on</button></p>'
    body = f'<form method="post">{fields}{button}</form>'
    return _page(study, card("Some questions", body) + _delete_link(person))


def trial_page(
    study: TrialStudy, person: Participant, session: str, meanings: Sequence[tuple[str, str]]
) -> str:
    """Return the page of a collaboration.

    Args:
        study: The study.
        person: The participant.
        session: The session of the trial.
        meanings: The name of each goal of the trial, and what has to hold for it.
    """
    facts = "".join(f"<dt>{escape(n)}</dt><dd>{escape(text)}</dd>" for n, text in meanings)
    main = (
        f"<nav><b>Task {person.trial + 1} of {study.trials}</b>"
        f"<details><summary>what counts as done</summary><dl>{facts}</dl></details>"
        f'<div id="next" hidden>{next_form("go on")}</div></nav>'
        f'<main id="page" data-api="/p/{person.code}/" data-sessions="{escape(session)}" '
        f'data-plain="{"" if study.shows_belief else "yes"}"></main>'
    )
    return document(study.title, main, SCRIPT)


def end_page(study: TrialStudy, person: Participant) -> str:
    """Return the last page."""
    body = "<p>That was all. Thank you very much for taking part.</p>"
    return _page(study, card("Thank you", body) + _delete_link(person))


def delete_page(study: TrialStudy, person: Participant) -> str:
    """Return the page that asks whether everything is to be deleted."""
    body = (
        "<p>Everything that is stored of you will be deleted. This cannot be undone.</p>"
        f'<form method="post"><button class="main">delete my data</button></form>'
        f'<p><a href="/p/{person.code}">back</a></p>'
    )
    return _page(study, card("Delete my data", body))


def deleted_page(study: TrialStudy) -> str:
    """Return the page after everything was deleted."""
    return _page(study, card("Deleted", "<p>Nothing is stored of you any more.</p>"))


def next_form(text: str) -> str:
    """Return the button that goes on to the next stage."""
    return f'<form method="post"><button class="main">{escape(text)}</button></form>'


def _page(study: TrialStudy, body: str) -> str:
    return document(study.title, f"<main><h1>{escape(study.title)}</h1>{body}</main>")


def _delete_link(person: Participant) -> str:
    return f'<p class="soft"><a href="/p/{person.code}/delete">delete my data</a></p>'


def _paragraphs(text: str) -> str:
    parts = (" ".join(part.split()) for part in text.split("\n\n"))
    return "".join(f"<p>{escape(part)}</p>" for part in parts if part)


def _field(question: FormQuestion) -> str:
    name, text = escape(question.name), escape(question.text)
    if question.kind == CHOICE:
        options = [(option, option) for option in question.options]
    elif question.kind == SCALE:
        low, high = question.options[:2]
        ends = {1: f" {low}", question.points: f" {high}"}
        options = [(str(n), f"{n}{ends.get(n, '')}") for n in range(1, question.points + 1)]
    else:
        return (
            f'<p><label for="{name}">{text}</label><br>'
            f'<input type="text" id="{name}" name="{name}" maxlength="{MAX_TEXT}"></p>'
        )
    radios = "".join(
        f'<label><input type="radio" name="{name}" value="{escape(value)}" required>'
        f"{escape(label)}</label> "
        for value, label in options
    )
    return f'<fieldset><legend>{text}</legend><div class="row">{radios}</div></fieldset>'
