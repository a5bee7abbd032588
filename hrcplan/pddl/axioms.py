"""Derived predicates (PDDL 2.2): ``(:derived (p ?x) CONDITION)``, read and put into strata."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from hrcplan.core.records import replace
from hrcplan.core.text import quote
from hrcplan.pddl.formulas import read_formula
from hrcplan.pddl.model import (
    OBJECT,
    And,
    Atom,
    Axiom,
    Formula,
    Not,
    Or,
    Param,
    Quantified,
    Signature,
)
from hrcplan.pddl.reader import GroupNode, WordNode
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.typed_lists import params_of

DERIVED = ":derived"


def read_axioms(root: GroupNode, scope: Scope) -> Iterator[Axiom]:
    """Yield the axioms of a domain; every fault is noted."""
    axioms_by_place: list[tuple[int, Axiom]] = []
    for node in root[2:]:
        if isinstance(node, GroupNode) and node.head == DERIVED:
            scope.source.use(":derived-predicates", node.at)
            axiom = _axiom(node, scope)
            if axiom is not None:
                axioms_by_place.append((node.at, axiom))
    axioms = [axiom for _, axiom in axioms_by_place]
    level = levels(axioms)
    unstratified = [(at, axiom) for at, axiom in axioms_by_place if axiom.name not in level]
    if unstratified:
        at, axiom = unstratified[0]
        message = f"{quote(axiom.name)} is derived from its own negation"
        hint = "derive it from facts that actions change, or remove one 'not'"
        scope.source.error(at, "not-stratified", message, hint)
    yield from axioms


def _axiom(node: GroupNode, scope: Scope) -> Axiom | None:
    source, head = scope.source, node[1] if len(node) > 1 else node
    if len(node) != 3 or not isinstance(head, GroupNode) or not head.head:
        hint = "put the conditions in one (and …)"
        if len(node) < 4 or not isinstance(head, GroupNode) or isinstance(node[2], WordNode):
            hint = "write the predicate with its variables, then one condition"
        message = "(:derived (p ?x) CONDITION) is expected here"
        source.error(node.at, "bad-axiom", message, hint)
        return None
    other = next((term for i, term in enumerate(head) if i and _is_constant(head, i)), None)
    if other is not None:
        message = "a derived predicate has variables only"
        hint = "write (:derived (p ?x) (and (= ?x a) …)), and one (:derived …) for each predicate"
        source.error(other.at, "bad-axiom", message, hint)
        return None
    name = head[0]
    assert isinstance(name, WordNode)
    signature = scope.signature(name, "predicate")
    params = params_of(head[1:], source, scope.domain.types)
    if signature is not None and len(signature.params) != len(params):
        message = f"{quote(name)} is declared as {signature}"
        source.error(head.at, "wrong-arity", message, "derive it with as many variables")
        return None
    if signature is not None:
        params = _with_types(params, signature)
    body = read_formula(node[2], scope.binding(params))
    return None if signature is None else Axiom(str(name), params, body)


def _is_constant(head: GroupNode, i: int) -> bool:
    """Whether a part of the head of an axiom is neither a variable nor behind a dash."""
    term, before = head[i], head[i - 1]
    if isinstance(term, GroupNode):
        return term.head != "either"
    return term[0] not in "?-" and not (isinstance(before, WordNode) and before[-1] == "-")


def _with_types(params: Sequence[Param], signature: Signature) -> tuple[Param, ...]:
    """Return parameters, those without a type with the one that the declaration gives."""
    return tuple(
        replace(param, types=predicate_param.types) if param.types == (OBJECT,) else param
        for param, predicate_param in zip(params, signature.params, strict=True)
    )


def levels(axioms: Sequence[Axiom]) -> dict[str, int]:
    """Return the stratum of every derived predicate; those without one are left out.

    What a predicate is derived from is in a lower stratum, or in the same one if the two are
    derived from each other; then neither may be derived from the negation of the other.
    """
    needs: dict[str, dict[str, bool]] = {axiom.name: {} for axiom in axioms}
    for axiom in axioms:
        for name, positive in uses(axiom.body):
            if name in needs:
                needs[axiom.name][name] = needs[axiom.name].get(name, True) and positive
    level: dict[str, int] = {}
    for stratum, names in enumerate(_components(needs)):
        if all(needs[name].get(other, True) for name in names for other in names):
            level.update(dict.fromkeys(names, stratum))
    return level


def _components(needs: Mapping[str, Mapping[str, bool]]) -> Iterator[frozenset[str]]:
    """Yield the strongly connected components of a graph, each after those that it needs."""
    needed_by: dict[str, list[str]] = {name: [] for name in needs}
    for name, others in needs.items():
        for other in others:
            needed_by[other].append(name)
    last_first = _postorder(list(needed_by), needed_by)[::-1]  # Kosaraju and Sharir
    visited: set[str] = set()
    for name in last_first:
        if name not in visited:
            component = _postorder([name], needs, visited)
            yield frozenset(component)


def _postorder(
    roots: Sequence[str], edges: Mapping[str, Collection[str]], visited: set[str] | None = None
) -> list[str]:
    """Return what is reachable from ``roots`` and not ``visited``, in the order it is left."""
    visited = set() if visited is None else visited
    order: list[str] = []
    for root in roots:
        if root in visited:
            continue
        visited.add(root)
        stack = [(root, iter(edges[root]))]
        while stack:
            name, rest = stack[-1]
            following = next((other for other in rest if other not in visited), None)
            if following is None:
                order.append(name)
                stack.pop()
            else:
                visited.add(following)
                stack.append((following, iter(edges[following])))
    return order


def uses(formula: Formula, positive: bool = True) -> Iterator[tuple[str, bool]]:
    """Yield the predicates of a formula, each with whether it stands there without negation."""
    match formula:
        case Atom(name):
            yield name, positive
        case Not(body):
            yield from uses(body, not positive)
        case Quantified(_, _, body):
            yield from uses(body, positive)
        case And(parts) | Or(parts):
            for part in parts:
                yield from uses(part, positive)
        case _:
            return
