"""The view of ``hrcplan bank show --htn``: the chains and cliques of a goal as a tree."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from hrcplan.core.numbers import int_text, nearest_float

if TYPE_CHECKING:
    from hrcplan.bank import PlanGraph, StepTable
    from hrcplan.bank.htn import Htn, Kind, OrderNode

MANY = 1e-4  # a smaller share is written with an exponent
WIDTH = 72  # a chain of steps stands on one line if that is no longer


def as_json(graph: PlanGraph, htn: Htn, table: StepTable) -> dict[str, Any]:
    """Return the document of the view; plans are exact numbers, as text."""
    return {
        "goal": htn.goal,
        "steps": graph.n_steps,
        "plans": int_text(htn.plans),
        "htn_plans": int_text(htn.orders),
        "exact": htn.exact,
        "added": htn.added,
        "complete": htn.complete and graph.complete,
        "kinds": [
            {
                "plans": int_text(kind.plans),
                "htn_plans": int_text(kind.orders),
                "exact": kind.exact,
                "added": kind.added,
                "tree": _tree(kind.root, table),
            }
            for kind in htn.kinds
        ],
    }


def _tree(node: OrderNode, table: StepTable) -> dict[str, Any]:
    from hrcplan.bank.htn import Chain, Leaf

    if isinstance(node, Leaf):
        return {"step": str(table[node.step])}
    extra = [[str(table[a]), str(table[b])] for a, b in node.added]
    kind = "chain" if isinstance(node, Chain) else "clique"
    return {kind: [_tree(child, table) for child in node.children], "added": extra}


def as_text(graph: PlanGraph, htn: Htn, table: StepTable) -> str:
    """Return the view in words: counts of orders and of plans, and the tree."""
    plans = f"{'' if graph.complete else '>= '}{int_text(htn.plans, ',')} plans"
    lines = [f"{htn.goal}: {graph.n_steps} steps, {plans}"]
    if htn.kinds:
        lines.append(f"chains and cliques allow {_counts_text(htn.orders, htn.plans, htn.exact)}")
    if htn.added:
        lines.append(f"{_constraints(htn.added)}: chains and cliques cannot do without")
    if not htn.complete:
        verb = "is" if len(htn.kinds) == 1 else "are"
        lines.append(f"only {len(htn.kinds)} of the sets of steps {verb} shown")
    for number, kind in enumerate(htn.kinds, start=1):
        lines.append("")
        if len(htn.kinds) > 1:
            lines.append(_title(number, kind, len(htn.kinds)))
        lines += _lines(kind.root, table)
    return "\n".join(lines)


def _counts_text(orders: int, plans: int, exact: bool) -> str:
    if not exact:
        return f"{int_text(orders, ',')} orders, which need not all be plans"
    if orders == plans:
        return "all of them"
    share = nearest_float(Fraction(orders, plans))
    return (
        f"{int_text(orders, ',')} of them ({f'{share:.2%}' if share >= MANY else f'{share:.0e}'})"
    )


def _title(number: int, kind: Kind, n: int) -> str:
    counts = _counts_text(kind.orders, kind.plans, kind.exact)
    return f"either {number} of {n}: {int_text(kind.plans, ',')} plans, allowed are {counts}"


def _constraints(n: int) -> str:
    return f"+ {n} order constraint{'' if n == 1 else 's'} that plans do not have"


def _lines(node: OrderNode, table: StepTable) -> Iterator[str]:
    """Yield a node, then what is below it, each line under the one it belongs to."""
    from hrcplan.bank.htn import Chain, Leaf

    if isinstance(node, Leaf):
        yield str(table[node.step])
        return
    if isinstance(node, Chain) and not node.added:
        steps = [str(table[child.step]) for child in node.children if isinstance(child, Leaf)]
        line = " → ".join(steps)
        if len(steps) == len(node.children) and len(line) <= WIDTH:
            yield line
            return
    order = "in this order" if isinstance(node, Chain) else "in any order"
    yield f"{order}  {_constraints(len(node.added))}" if node.added else order
    for i, child in enumerate(node.children):
        last = i == len(node.children) - 1
        first, rest = ("└─ ", "   ") if last else ("├─ ", "│  ")
        for j, line in enumerate(_lines(child, table)):
            yield (rest if j else first) + line
