"""``hrcplan allocation``: at which values of an agent state the best allocation flips."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import click

from hrcplan.cli import options, output

if TYPE_CHECKING:
    from hrcplan.core.numbers import Number
    from hrcplan.planners.allocation import Diagram, Line


@click.command(
    "allocation",
    cls=options.SettingsCommand,
    epilog=options.notes(
        options.NAMES,
        'ELEMENT: a function of an agent in quotes, as in "motivation human".',
        options.PLANNER,
        options.SETTING,
    ),
)
@click.argument("names", nargs=-1, required=True, metavar="DOMAIN PROBLEM ELEMENT")
@click.option(
    "--range",
    "limits",
    nargs=2,
    type=options.FiniteNumber(),
    metavar="LEAST MOST",
    help="The values of ELEMENT to examine; by default the range in the domain file, else 0 10.",
)
@options.planner("Which planner to ask; the result is exact if its plans are proven.")
@options.timeout("Seconds for each plan.", 60.0)
@options.settings
@output.common_options
def command(
    names: tuple[str, ...],
    limits: tuple[float, float] | None,
    planner: str,
    timeout: float,
    settings: tuple[str, ...],
) -> int:
    """Show which agent does how much in the best plan, for every value of ELEMENT.

    The values at which another allocation becomes best are computed exactly where plans are proven
    to be optimal, and so is the distance of the present value from the next one. Where a proof is
    out of reach the diagram is approximate, and says so.
    """
    from hrcplan.cli.arguments import problem_of, split_names
    from hrcplan.core.numbers import exact
    from hrcplan.pddl.settings import parse_function
    from hrcplan.planners.allocation import LEAST, MOST, diagram

    domain, name, (element,) = split_names(names, 1)
    problem = problem_of(domain, name, settings)
    key = parse_function(element, problem)
    least, most = problem.domain.value_range(key[0]) or (LEAST, MOST)
    if limits is not None:
        least, most = (exact(Fraction(str(limit))) for limit in limits)
    diagram_of_value = diagram(problem, key, least, most, planner=planner, timeout_s=timeout)
    if output.JSON:
        output.document(as_json(diagram_of_value))
    else:
        output.result(as_text(diagram_of_value, f"{domain}/{name}"))
    return 0


def as_json(chart: Diagram) -> dict[str, Any]:
    """Return a diagram as a JSON object; ``metric`` is ``intercept`` + ``slope`` x value."""
    number = output.number
    stays = chart.stays_best(chart.at_now)
    return {
        "element": " ".join(chart.key),
        "value": number(chart.value),
        "flips": [number(flip) for flip in chart.flips],
        "radius": number(chart.radius()),
        "proven": chart.is_proven,
        "stays_best": None if stays is None else [number(limit) for limit in stays],
        "pieces": [
            {
                "from": number(piece.least),
                "to": number(piece.most),
                "intercept": number(piece.line.intercept),
                "slope": number(piece.line.slope),
                "n_actions": dict(piece.n_actions),
                "plan": [str(action) for action in piece.line.plan.actions],
            }
            for piece in chart.pieces
        ],
    }


def as_text(chart: Diagram, title: str) -> str:
    """Return a diagram as a table, and in words how far the value may move."""
    agents = list(chart.pieces[0].n_actions)
    head = [" ".join(chart.key), *(agent or "-" for agent in agents), "metric"]
    rows = [
        [
            f"{_text(piece.least)} … {_text(piece.most)}",
            *(str(piece.n_actions.get(agent, 0)) for agent in agents),
            _line(piece.line),
        ]
        for piece in chart.pieces
    ]
    lines = output.columns([head, output.rule([head, *rows]), *rows])
    mark = "" if chart.is_proven else " (approximate: not all plans are proven to be the best)"
    return "\n".join([f"{title}: who does how much{mark}", "", *(f"  {x}" for x in lines), "",
                      _in_words(chart)])  # fmt: skip


def _in_words(chart: Diagram) -> str:
    radius = chart.radius()
    if radius is None:
        return f"now {_text(chart.value)}: one allocation is best throughout"
    flips = ", ".join(_text(flip) for flip in chart.flips)
    return f"flips at {flips}; now {_text(chart.value)}, so it may move by {_text(radius)}"


def _line(line: Line) -> str:
    if not line.slope:
        return _text(line.intercept)
    return f"{_text(line.intercept)} + {_text(line.slope)} v"


def _text(number: Number) -> str:
    """Return a number in at most six digits, and the fraction if they are not exact."""
    short = f"{float(number):.6g}"
    return short if Fraction(short) == number else f"{short} ({number})"
