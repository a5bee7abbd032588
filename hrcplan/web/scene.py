"""What can be drawn of a world, read off its PDDL: who is where, who holds what, and a map.

No note is needed. A fact says where an object is if actions exchange it for another such fact of
the same object: ``at`` of a mover for ``at``, ``box-at`` of a box for ``holding``. A fact of two
objects that is only ever added is a place, too (an ingredient ``in`` a dish), unless it follows
from another one. All other facts are badges. ``;; hrcplan: show`` notes override this.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from hrcplan.execution.action_model import ActionModel
from hrcplan.pddl.annotations import COLORS, VIEWS
from hrcplan.pddl.conventions import AGENT, robots
from hrcplan.pddl.model import Action, Atom, Domain, Note, Problem
from hrcplan.pddl.walks import conjuncts
from hrcplan.web.map import map_of

PLACE, HOLD, ZONE, BADGE = "place", "hold", "zone", "badge"
_Slot = tuple[str, int]
"""A parameter of a predicate: the predicate, and the place of the parameter."""


@dataclass(frozen=True, slots=True)
class FactView:
    """How facts of one predicate are drawn.

    Attributes:
        show: ``place`` (an object is at another one), ``hold`` (an agent has it), ``zone`` (an
            object is in a place that is named after the predicate), ``badge``, or ``hide``.
        of: The place of the parameter that the fact is about.
        at: The place of the parameter where it is; None if that is no object.
    """

    show: str
    of: int = 0
    at: int | None = None

    def to_json(self) -> dict[str, Any]:
        """Return it as a JSON object."""
        return {"show": self.show, "of": self.of, "at": self.at}


def scene_of(problem: Problem) -> dict[str, Any]:
    """Return what a page needs to draw states of a problem, as a JSON object.

    Its keys: ``agents`` (name, and whether it is a robot), ``objects`` (type, icon and color by
    name), ``views`` (a `FactView` by predicate), ``facts`` (the changing ones at the beginning),
    ``static`` (predicates that no action changes) and ``map`` (positions and ways, or None).
    """
    model = ActionModel(problem)
    views = fact_views(problem.domain, problem)
    machines = robots(problem)
    facts = model.changing(model.initial())
    return {
        "agents": [{"name": name, "robot": name in machines} for name in problem.agents],
        "objects": {n: _object(problem, n, kind) for n, kind in problem.all_objects.items()},
        "views": {name: view.to_json() for name, view in views.items()},
        "facts": sorted(" ".join(fact) for fact in facts),
        "map": map_of(problem, _agents_places(problem, views)),
    }


def _object(problem: Problem, name: str, kind: str) -> dict[str, str]:
    look = {"type": kind}
    for note in (*problem.domain.notes, *problem.notes):
        if note.kind == "show" and problem.domain.is_a(kind, (note.name,)):
            look |= _look(note)
    for note in (*problem.domain.notes, *problem.notes):
        if note.kind == "show" and note.name == name:
            look |= _look(note)
    return look


def _look(note: Note) -> dict[str, str]:
    """Return icon and color of a note: what is a color name is the color."""
    return {("color" if word in COLORS else "icon"): word for word in note.phrases}


def fact_views(domain: Domain, problem: Problem) -> dict[str, FactView]:
    """Return how facts of each predicate are drawn that an action changes."""
    changed = _changes(domain)
    views = {name: FactView(BADGE) for name in domain.predicates if name in changed}
    movers = _movers(domain)
    for name, of in movers.items():
        views[name] = _located(domain, name, of)
    for name in _added_places(domain, set(movers)):
        views[name] = FactView(PLACE, 0, 1)
    for name in _zones(domain, problem, movers):
        views[name] = FactView(ZONE)
    for note in domain.notes:
        if note.kind == "show" and note.name in views:
            views[note.name] = _chosen(domain, note, views[note.name])
    return views


def _chosen(domain: Domain, note: Note, view: FactView) -> FactView:
    show = next((word for word in note.phrases if word in VIEWS), view.show)
    n_params = len(domain.predicates[note.name].params)
    if show == PLACE and n_params > 1 and view.at is None:
        return _located(domain, note.name, 0)
    return FactView(show, view.of, view.at if show == PLACE else None)


def _located(domain: Domain, name: str, of: int) -> FactView:
    params = domain.predicates[name].params
    at = next(i for i in range(len(params)) if i != of)
    holds = all(_is_agent(domain, kind) for kind in params[at].types)
    return FactView(HOLD if holds else PLACE, of, at)


def _is_agent(domain: Domain, kind: str) -> bool:
    return AGENT in domain.types and domain.is_a(kind, (AGENT,))


def _changes(domain: Domain) -> frozenset[str]:
    return frozenset(
        effect.target.name
        for action in domain.actions
        for effect in action.effects
        if isinstance(effect.target, Atom)
    )


def _exchanges(action: Action) -> Iterator[tuple[_Slot, _Slot]]:
    """Yield pairs of parameters: a fact of an object goes, and another one of it comes."""
    atoms = [(e.kind, e.target) for e in action.effects if isinstance(e.target, Atom)]
    gone = {atom for kind, atom in atoms if kind == "delete"}
    come = {atom for kind, atom in atoms if kind == "add"}
    for before in gone - come:
        for after in come - gone:
            for i, word in enumerate(before.args):
                for j, other in enumerate(after.args):
                    if word == other and word.startswith("?"):
                        yield (before.name, i), (after.name, j)


def _movers(domain: Domain) -> dict[str, int]:
    """Return which parameter of each predicate of several objects is the one that moves."""
    votes: dict[str, Counter[int]] = {}
    for action in domain.actions:
        for before, after in _exchanges(action):
            sizes = [len(domain.predicates[name].params) for name, _ in (before, after)]
            weight = 10 if min(sizes) > 1 else 1  # a fact of two objects says more
            for (name, i), n_params in zip((before, after), sizes, strict=True):
                if n_params > 1:
                    votes.setdefault(name, Counter())[i] += weight
    return {name: min(count, key=lambda i: (-count[i], i)) for name, count in votes.items()}


def _zones(domain: Domain, problem: Problem, movers: Mapping[str, int]) -> list[str]:
    """Return the predicates of one object that say where it is, as ``ontable`` does."""
    votes: Counter[str] = Counter()
    for action in domain.actions:
        for pair in _exchanges(action):
            for (name, _), (other, i) in (pair, pair[::-1]):
                if len(domain.predicates[name].params) == 1:
                    votes[name] += 10 if movers.get(other) == i else movers.get(other) is None
    names = {name for name in votes if votes[name]} - _come_with_a_place(domain, movers)
    strongest_first = sorted(names, key=lambda name: (-votes[name], name))
    zones: list[str] = []
    for name in strongest_first:
        if not any(_hold_together(problem, name, other) for other in zones):
            zones.append(name)
    return zones if len(zones) > 1 or any(votes[name] >= 10 for name in zones) else []


def _come_with_a_place(domain: Domain, movers: Mapping[str, int]) -> set[str]:
    """Return predicates whose facts an action adds together with the place of the same object."""
    names = set()
    for action in domain.actions:
        come = [e.target for e in action.effects if e.kind == "add" and isinstance(e.target, Atom)]
        placed = {atom.args[movers[atom.name]] for atom in come if atom.name in movers}
        names |= {atom.name for atom in come if len(atom.args) == 1 and atom.args[0] in placed}
    return names


def _hold_together(problem: Problem, name: str, other: str) -> bool:
    """Return whether an object has both facts at the beginning: then one of them is no place."""
    mine = {fact[1] for fact in problem.facts if fact[0] == name}
    return any(fact[0] == other and fact[1] in mine for fact in problem.facts)


def _added_places(domain: Domain, movers: set[str]) -> Iterator[str]:
    """Yield predicates of two objects that are added only, and follow from no other of these."""
    deleted = {e.target.name for a in domain.actions for e in a.effects if e.kind == "delete"}
    for name, signature in domain.predicates.items():
        is_pair = len(signature.params) == 2 and name in _changes(domain)
        if not is_pair or name in deleted or name in movers:
            continue
        kinds = [kind for param in signature.params for kind in param.types]
        if not any(_is_agent(domain, kind) for kind in kinds) and not _follows(domain, name):
            yield name


def _follows(domain: Domain, name: str) -> bool:
    """Return whether what adds a fact needs another changing fact of the same objects."""
    changed = _changes(domain)
    for action in domain.actions:
        for effect in action.effects:
            target = effect.target
            if not isinstance(target, Atom) or (target.name, effect.kind) != (name, "add"):
                continue
            needs = (p for c in action.conditions for p in conjuncts(c.formula))
            if any(
                isinstance(n, Atom) and n.name in changed and set(n.args) == set(target.args)
                for n in needs
            ):
                return True
    return False


def _agents_places(problem: Problem, views: Mapping[str, FactView]) -> tuple[str, ...]:
    """Return the objects at which agents can be, in the order of the problem."""
    domain = problem.domain
    places: set[str] = set()
    for name, view in views.items():
        if view.show != PLACE or view.at is None:
            continue
        params = domain.predicates[name].params
        moves = any(domain.is_a(AGENT, (kind,)) for kind in params[view.of].types)
        if (AGENT in domain.types and moves) or _holds_agents(domain, params[view.of].types):
            places.update(problem.objects_of(params[view.at].types))
    return tuple(name for name in problem.all_objects if name in places)


def _holds_agents(domain: Domain, kinds: tuple[str, ...]) -> bool:
    return any(_is_agent(domain, kind) for kind in kinds)
