"""``hrcplan planners``: the cards of the planners, and which of them can run here."""

from __future__ import annotations

from dataclasses import asdict

import rich_click as click

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
        output.result(f"{card.name:14} {card.summary}")
        output.result(f"{'':14} {', '.join(kinds)}; metric: {card.metric}; {proof}; {card.licence}")
        if missing:
            output.result(f"{'':14} missing: {missing}")
    output.result("up:NAME        any installed unified-planning engine, as in up:pyperplan")
    output.result("cmd:PROGRAM …  any program, as in 'cmd:popf {domain} {problem}'")
