"""``hrcplan planners``: the cards of the planners, and which of them can run here."""

from __future__ import annotations

from dataclasses import asdict

import click

from hrcplan.cli import output


@click.command("planners")
@output.common_options
def command() -> None:
    """List the planners: the problems each can solve, and whether it can run here."""
    from hrcplan.planners import registry

    cards = [(p.card, p.missing()) for p in map(registry.make, registry.names())]
    if output.JSON:
        output.document({"planners": [
            {**asdict(card), "constructs": sorted(card.constructs), "present": missing is None,
             "missing": missing}
            for card, missing in cards
        ]})  # fmt: skip
        return
    for card, missing in cards:
        kinds = [kind for kind in ("classical", "temporal", "numeric") if getattr(card, kind)]
        proof = "proves optimality" if card.proves else "proves nothing"
        _line(card.name, card.summary)
        _line("", f"{', '.join(kinds)}; metric: {card.metric}; {proof}; {card.licence}")
        if missing:
            _line("", f"missing: {missing}")
    _line("up:NAME", "any installed unified-planning engine, as in up:pyperplan")
    _line("cmd:PROGRAM …", "any program, as in 'cmd:popf {domain} {problem}'")


def _line(name: str, text: str) -> None:
    output.result(output.fold(f"{name:14} {text}", indent=15))
