"""The page of a report: one static HTML file, with its style and plots in it."""

from __future__ import annotations

import html as markup
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hrcplan.studies.study import Claim, Findings, Section
from hrcplan.studies.verdict import FAILS, HOLDS, TOO_FEW

STYLE = Path(__file__).with_name("page.css")
_VERDICTS = {
    HOLDS: ("yes", "holds"),
    FAILS: ("no", "does not hold"),
    TOO_FEW: ("few", "too few runs to tell"),
}
GUIDE = "How to read these figures"
WORDS = {
    "cell": "All runs of one row and column; <em>n</em> is their number.",
    "paired": "Run 17 meets the same human in every cell, so differences are taken run by run.",
    "±": "One standard error of a mean. Values that share a goal are not taken as independent.",
    "interval": "95 %, by Student's t.",
    "verdict": "A claim <em>holds</em> if the intervals it is about lie within its bounds, and "
    "<em>does not hold</em> if one lies wholly outside; else there are <em>too few runs to "
    "tell</em>.",
    "margin": "<em>Non-inferior by a margin</em>: the whole interval is better than the margin.",
    "cap": "What an episode costs that did not reach its goal, however short it was.",
}
_INTERVAL = re.compile(
    r"± [\d.]+(?:</span><small>[\u2212\d.]+ to [\u2212\d.]+)?|\d\.\d\d to \u2212?\d+\.\d\d"
)


def html(title: str, about: Mapping[str, Any], n_rows: int, findings: Findings) -> str:
    """Return the page of a study."""
    parts = [*_claims(findings.claims), *findings.sections, _guide()]
    sections = "\n".join(
        f'<section id="{anchor(s.title)}">\n<h2>{escape(s.title)}</h2>\n{s.html}\n</section>'
        for s in parts
    )
    contents = " ".join(f'<a href="#{anchor(s.title)}">{escape(s.title)}</a>' for s in parts)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<style>
{STYLE.read_text(encoding="utf-8")}</style>
</head>
<body>
<header>
<p class="kind">hrcplan study</p>
<h1>{escape(title)}</h1>
<p class="lead">{findings.lead}</p>
<p class="facts">{_facts(about, n_rows)}</p>
<p class="facts">{_multiplicity(sections)}</p>
<p class="facts"><a href="#{anchor(GUIDE)}">{GUIDE}</a></p>
<nav>{contents}</nav>
</header>
<main>
{sections}
</main>
</body>
</html>
"""


def _guide() -> Section:
    """Return the section that says what the words of the page mean."""
    lines = "".join(f"<dt>{word}</dt><dd>{meaning}</dd>" for word, meaning in WORDS.items())
    more = (
        "<p>More, and what was chosen on what: the page <em>How to read these figures</em> of the "
        "documentation (<code>docs/papers/reading-figures.md</code>).</p>"
    )
    return Section(GUIDE, f"<dl>{lines}</dl>{more}")


def _facts(about: Mapping[str, Any], n_rows: int) -> str:
    options = ", ".join(f"{key} {value}" for key, value in about["options"].items() if value)
    parts = [f"{n_rows:,} rows", f"seed {about['seed']}", options, f"hrcplan {about['version']}"]
    return " · ".join(escape(part) for part in parts if part)


def _multiplicity(sections: str) -> str:
    """Return how many intervals a page holds, and what that means."""
    n = len(_INTERVAL.findall(sections))
    if not n:
        return ""
    return (
        f"{n:,} means and differences stand here with an error or a 95 % interval. They are not "
        "corrected for their number: about one in twenty misses its true value at random."
    )


def _claims(claims: Sequence[Claim]) -> list[Section]:
    """Return a section per group of claims, in the order of their first ones."""
    groups = dict.fromkeys(c.group for c in claims)
    return [
        Section(group, "\n".join(_claim(c) for c in claims if c.group == group)) for group in groups
    ]


def _claim(claim: Claim) -> str:
    kind, verdict = _VERDICTS[claim.verdict]
    return (
        f'<article class="claim {kind}"><p class="verdict">{verdict}</p>'
        f"<div><h3>{escape(claim.claim)}</h3><p>{escape(claim.evidence)}</p></div></article>"
    )


def readings(subjects: str) -> Section:
    """Return the section that says where readings of a paper are explained."""
    words = (
        f"<p>Where the paper is silent a reading was chosen: {subjects}. The page of the paper in "
        "the documentation lists all of them with their reasons. A claim that lacks rows is not "
        "stated. Every number but measured times can be computed again from "
        "<code>rows.sqlite</code>, which has one row per episode.</p>"
    )
    return Section("Readings", words)


def escape(text: str | float) -> str:
    """Return text as HTML."""
    return markup.escape(str(text), quote=True)


def anchor(title: str) -> str:
    """Return the name by which links find a section.

    >>> anchor("Table I, and the paper")
    'table-i-and-the-paper'
    """
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")


def table(head: Sequence[str], rows: Sequence[Sequence[str]], kind: str = "") -> str:
    """Return a table; its cells are HTML already, the first of each row is its heading."""
    top = "".join(f'<th scope="col">{cell}</th>' for cell in head)
    body = "\n".join(
        f'<tr><th scope="row">{row[0]}</th>{"".join(f"<td>{cell}</td>" for cell in row[1:])}</tr>'
        for row in rows
    )
    return (
        f'<div class="scroll"><table class="{kind}">\n<thead><tr>{top}</tr></thead>\n'
        f"<tbody>\n{body}\n</tbody></table></div>"
    )


def picture(svg: str, caption: str) -> str:
    """Return a plot with its caption, which is HTML."""
    return f"<figure>{svg}<figcaption>{caption}</figcaption></figure>"


def panels(svgs: Sequence[str], caption: str, keys: str = "", kind: str = "") -> str:
    """Return small plots that stand side by side as far as there is room, with keys above."""
    inner = "".join(f"<div>{svg}</div>" for svg in svgs)
    return (
        f'<figure>{keys}<div class="{f"panels {kind}".strip()}">{inner}</div>'
        f"<figcaption>{caption}</figcaption></figure>"
    )


def key(color: str, kind: str = "") -> str:
    """Return a small mark in a color; of kind ``line`` a stroke."""
    return f'<i class="{f"key {kind}".strip()}" style="color:{color}"></i>'


def keys(marks: Sequence[tuple[str, str, str]]) -> str:
    """Return what colors stand for: each a name, a color, and the kind of its mark."""
    inner = "".join(f"<span>{key(color, kind)}{escape(name)}</span>" for name, color, kind in marks)
    return f'<p class="keys">{inner}</p>'
