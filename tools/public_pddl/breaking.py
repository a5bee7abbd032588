"""Mutants of public files that are certainly broken, and what ``hrcplan check`` says of them."""

from __future__ import annotations

import contextlib
import io
import random
import re
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from hrcplan.cli import main as command
from public_pddl.archive import Pair

Texts = tuple[str, str]
"""A domain and a problem."""

_COMMENT = re.compile(r";[^\n]*")
_FACT = re.compile(r"\(\s*(?!(?:=|at|not|and|or)\s)([A-Za-z][\w-]*)((?:\s+[A-Za-z][\w-]*)+)\s*\)")
_TYPED = re.compile(r"(\?[\w-]+\s+-\s+)[A-Za-z][\w-]*")
_KEYWORD = re.compile(r":(parameters|precondition|effect|predicates|condition)\b", re.IGNORECASE)
_PROBLEM_KEYWORD = re.compile(r":(objects|init|goal)\b", re.IGNORECASE)
_INIT = re.compile(r"\(\s*:init\b", re.IGNORECASE)
_GOAL = re.compile(r"\(\s*:goal\b", re.IGNORECASE)
BAD_INPUT = 3


def parenthesis(rng: random.Random, texts: Texts) -> Texts | None:
    """Drop or double one parenthesis, of the domain or of the problem."""
    which = rng.randrange(2)
    text = texts[which]
    at = rng.choice([i for i, letter in enumerate(text) if letter in "()"])
    text = text[:at] + rng.choice(["", text[at] * 2]) + text[at + 1 :]
    return (text, texts[1]) if which == 0 else (texts[0], text)


def _of_fact(
    change: Callable[[re.Match[str]], str],
) -> Callable[[random.Random, Texts], Texts | None]:
    """Return a change of one fact of the initial state."""

    def mutate(rng: random.Random, texts: Texts) -> Texts | None:
        begin, end = _INIT.search(texts[1]), _GOAL.search(texts[1])
        if begin is None or end is None or end.start() < begin.end():
            return None
        facts = list(_FACT.finditer(texts[1], begin.end(), end.start()))
        if not facts:
            return None
        fact = rng.choice(facts)
        return texts[0], texts[1][: fact.start()] + change(fact) + texts[1][fact.end() :]

    return mutate


def undeclared_type(rng: random.Random, texts: Texts) -> Texts | None:
    """Give a variable of the domain a type that is nowhere declared."""
    return _replaced(rng, texts, 0, _TYPED, lambda match: f"{match[1]}no-such-type")


def keyword(rng: random.Random, texts: Texts) -> Texts | None:
    """Misspell a keyword of the domain."""
    return _replaced(rng, texts, 0, _KEYWORD, lambda match: f":{match[1][:-1]}")


def problem_keyword(rng: random.Random, texts: Texts) -> Texts | None:
    """Misspell a keyword of the problem."""
    return _replaced(rng, texts, 1, _PROBLEM_KEYWORD, lambda match: f":{match[1][:-1]}")


def _replaced(
    rng: random.Random,
    texts: Texts,
    which: int,
    pattern: re.Pattern[str],
    change: Callable[[re.Match[str]], str],
) -> Texts | None:
    places = list(pattern.finditer(texts[which]))
    if not places:
        return None
    place = rng.choice(places)
    text = texts[which][: place.start()] + change(place) + texts[which][place.end() :]
    return (text, texts[1]) if which == 0 else (texts[0], text)


KINDS: dict[str, Callable[[random.Random, Texts], Texts | None]] = {
    "parenthesis": parenthesis,
    "undeclared predicate": _of_fact(lambda fact: f"(no-such-predicate{fact[2]})"),
    "undeclared object": _of_fact(lambda fact: f"({fact[1]} {' '.join(_unknown(fact))})"),
    "one argument too many": _of_fact(lambda fact: f"({fact[1]}{fact[2]} {fact[2].split()[0]})"),
    "one argument too few": _of_fact(lambda fact: f"({fact[1]} {' '.join(fact[2].split()[1:])})"),
    "undeclared type": undeclared_type,
    "keyword of the domain": keyword,
    "keyword of the problem": problem_keyword,
}


def _unknown(fact: re.Match[str]) -> list[str]:
    return ["no-such-object", *fact[2].split()[1:]]


def exit_code(arguments: Sequence[str]) -> tuple[int, str]:
    """Return the exit code of a command that is run in this process, and what it prints."""
    text = io.StringIO()
    with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
        try:
            command.main(list(arguments))
        except SystemExit as stop:
            code = int(stop.code or 0)
    return code, text.getvalue()


def report(readable: Sequence[Pair], n: int, seed: int) -> None:
    """Print how many of ``n`` mutants end with exit code 3, by kind, and those that do not."""
    rng = random.Random(seed)
    total, refused = Counter[str](), Counter[str]()
    with TemporaryDirectory() as folder:
        files = Path(folder, "domain.pddl"), Path(folder, "problem.pddl")
        while sum(total.values()) < n:
            pair, kind = rng.choice(readable), list(KINDS)[sum(total.values()) % len(KINDS)]
            sources = (pair.domain, pair.problem)
            texts = tuple(_COMMENT.sub("", path.read_text(errors="replace")) for path in sources)
            mutant = KINDS[kind](rng, (texts[0], texts[1]))
            if mutant is None:
                continue
            for file, text in zip(files, mutant, strict=True):
                file.write_text(text)
            code, message = exit_code(["check", *map(str, files)])
            total[kind] += 1
            if code == BAD_INPUT and "Traceback" not in message:
                refused[kind] += 1
            else:
                print(f"- {kind} in {pair.domain} {pair.problem}: exit {code}: {message[:300]}")
    print("\n| broken mutants | made | refused with exit code 3 |\n|---|---|---|")
    for kind in KINDS:
        print(f"| {kind} | {total[kind]} | {refused[kind]} |")
    print(f"| all | {sum(total.values())} | {sum(refused.values())} |", flush=True)
