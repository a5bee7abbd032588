"""The tree of a problem file to a Problem of its domain; every fault is noted."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from hrcplan.core.numbers import Number, number_text, to_number
from hrcplan.core.text import nearest, quote
from hrcplan.pddl.annotations import read_problem_notes
from hrcplan.pddl.conventions import check_problem
from hrcplan.pddl.cures import groups_of, report_loose
from hrcplan.pddl.domain import declared_name, read_objects, sections_of
from hrcplan.pddl.effects import ASSIGNMENTS
from hrcplan.pddl.formulas import (
    OBJECT_FLUENTS,
    read_atom,
    read_expression,
    read_formula,
    read_function,
)
from hrcplan.pddl.initial_values import check_values
from hrcplan.pddl.model import (
    TOTAL_TIME,
    TRUE,
    Atom,
    Domain,
    Expr,
    Fact,
    FluentKey,
    Formula,
    Preference,
    Problem,
    TimedChange,
    fact_text,
)
from hrcplan.pddl.preferences import read_preferences, with_names
from hrcplan.pddl.reader import FlatNode, GroupNode, ParseNode, WordNode
from hrcplan.pddl.requirements import check_requirements, read_requirements
from hrcplan.pddl.scope import Scope, decimal_cure, looks_numeric
from hrcplan.pddl.source import SourceText
from hrcplan.pddl.trajectories import SECTION, read_constraints
from hrcplan.pddl.typed_lists import report_types

_SECTIONS = (":domain", ":requirements", ":objects", ":init", ":goal", ":metric", SECTION)
_SENSES = ("minimize", "maximize")
_LOGIC = frozenset(["and", "or", "imply", "forall", "exists", "when"])


def named_domain(root: GroupNode) -> WordNode | None:
    """Return the domain's name that a problem tree gives, or None if it gives none."""
    for node in root:
        if isinstance(node, GroupNode) and node.head == ":domain" and len(node) == 2:
            return node[1] if isinstance(node[1], WordNode) else None
    return None


def read_problem(root: GroupNode, source: SourceText, domain: Domain) -> Problem:
    """Return the problem that a ``(define (problem …) …)`` tree describes."""
    name = declared_name(root, "problem", source)
    sections = sections_of(root, source, _SECTIONS)
    flags = read_requirements(sections.get(":requirements"), source)
    objects = read_objects(sections.get(":objects"), source, domain.types, domain.constants)
    scope = Scope(source, domain, {**domain.constants, **objects}, {})
    init = _Init(scope)
    for node in groups_of(_consume(sections.get(":init")), scope, "fact"):
        init.take(node)
    goal, preferences = _goal(sections.get(":goal"), root, scope)
    constraints = read_constraints(sections.get(SECTION), scope)
    metric_scope = with_names(scope, preferences, constraints)
    metric, maximize = _metric(sections.get(":metric"), metric_scope)
    problem = Problem(
        name=name,
        domain=domain,
        objects=objects,
        facts=frozenset(init.facts),
        values=init.values,
        goal=goal,
        metric=metric,
        maximize=maximize,
        timed=tuple(sorted(init.timed_changes, key=lambda change: change.time)),
        preferences=preferences,
        constraints=constraints,
        notes=read_problem_notes(source, domain, objects),
        path=source.path,
    )
    if domain.requirements:
        check_requirements([*domain.requirements, *flags], source)
    report_types(source, domain.types)
    _check_domain(root, source, domain)
    at = sections.get(":init", root).at
    check_problem(problem, at, source)
    if not source.has_errors:
        check_values(problem, at, init.places, source)
    return problem


def _consume(section: GroupNode | None) -> Iterator[ParseNode]:
    """Yield what a section holds; each node is freed when it is read, as there may be a million."""
    if section is not None:
        section.reverse()
        section.pop()  # the head
        while section:
            yield section.pop()


def _check_domain(root: GroupNode, source: SourceText, domain: Domain) -> None:
    name = named_domain(root)
    if name is None:
        source.error(root.at, "no-domain", "the problem does not say its (:domain NAME)", "add it")
    elif domain.name and name != domain.name:
        message = f"the problem is for domain {quote(name)}, not {quote(domain.name)}"
        # Two files that fit each other are meant together, whatever the names say.
        report = source.error if source.has_errors else source.warn
        report(name.at, "domain-mismatch", message, nearest(name, [domain.name]))


class _Init:
    """Facts and values of ``:init``, one element at a time."""

    def __init__(self, scope: Scope) -> None:
        self.scope = scope
        self.facts: set[Fact] = set()
        self.values: dict[FluentKey, Number] = {}
        self.places: dict[FluentKey, int] = {}
        self.timed_changes: list[TimedChange] = []
        self._changes: dict[tuple[Number, Fact], TimedChange] = {}
        self.negative_facts: set[FluentKey] = set()
        self._terms: dict[tuple[str, ...], dict[str, str]] = {}
        self._predicates: dict[str, Sequence[Mapping[str, str]]] = {}

    def _words_of(self, predicate: str) -> Sequence[Mapping[str, str]]:
        """Return what the words of a fact can be: its name, then the objects of each parameter."""
        domain = self.scope.domain
        signature = domain.predicates.get(predicate)
        if signature is None or predicate in domain.derived or predicate in _LOGIC:
            return ()
        terms = (self._objects_of(param.types) for param in signature.params)
        return ({signature.name: signature.name}, *terms)

    def _objects_of(self, types: tuple[str, ...]) -> Mapping[str, str]:
        """Return the objects that a parameter takes, as keys and values."""
        if types not in self._terms:
            objects, is_a = self.scope.objects, self.scope.domain.is_a
            kinds = {kind for kind in set(objects.values()) if is_a(kind, types)}
            self._terms[types] = {name: name for name, kind in objects.items() if kind in kinds}
        return self._terms[types]

    def take(self, node: GroupNode) -> None:
        source = self.scope.source
        if isinstance(node, FlatNode):
            fact = self._plain_fact(node)
            if fact is not None:
                self._add(fact, node)
                return
        if self.scope.is_atom(node):
            self._fact(node)
        elif node.head == "and":
            message = "facts of :init are listed one after the other"
            source.error(node.at, "not-a-fact", message, "leave the (and …) out")
            for part in groups_of(node[1:], self.scope, "fact"):
                self.take(part)
        elif not node.head:
            report_loose([node], self.scope, "fact")
        elif node.head in _LOGIC:
            message = "a fact such as (p a b) is expected here"
            source.error(node.at, "not-a-fact", message, "list every fact that holds at first")
        elif self._is_value(node):
            message = f"{quote(node.head)} cannot stand in :init"
            source.error(node.at, "not-a-fact", message, "a function is set by (= (f a) NUMBER)")
        elif node.head == "=":
            self._value(node)
        elif node.head == "at" and any(map(_is_timed, node[1:])):
            self._timed_literal(node)
        elif node.head == "not":
            self._negative_fact(node)
        else:
            self._fact(node)

    def _plain_fact(self, node: FlatNode) -> Fact | None:
        """Return the fact that a node is; None if anything about it needs a second look."""
        words = node.words()
        options = self._predicates.get(words[0])
        if options is None:
            options = self._predicates[words[0]] = self._words_of(words[0])
        try:
            pairs = zip(options, words, strict=True)
            return tuple([names[word] for names, word in pairs])  # one string for each name
        except (KeyError, ValueError):
            return None

    def _is_value(self, node: GroupNode) -> bool:
        """Return whether a group was meant to set a function: ``(f 1)``, ``(increase (f) 1)``."""
        domain = self.scope.domain
        if node.head in domain.predicates:
            return False
        sets = node.head in domain.functions and looks_numeric(str(node[-1]))
        return sets or node.head in ASSIGNMENTS or (len(node) == 1 and "=" in node.head)

    def _timed_literal(self, node: GroupNode) -> None:
        """Take a change that comes by itself, such as ``(at 9 (open))``."""
        source, word, change = self.scope.source, node[1], node[-1]
        source.use(":timed-initial-literals", node.at)
        time = to_number(word) if isinstance(word, WordNode) else None
        if time is None or time < 0 or len(node) != 3 or not isinstance(change, GroupNode):
            cure = decimal_cure(word) if isinstance(word, WordNode) else None
            hint = cure or "write (at TIME (p a b)), with a time that is not below zero"
            message = "a change at a time has a number and one fact"
            source.error(word.at, "bad-number" if len(node) == 3 else "not-a-fact", message, hint)
        elif change.head == "=":
            if len(change) != 3:
                self._report_value(change)
                return
            function = read_function(change[1], self.scope)
            value = self._number(change[2])
            if function is not None and value is not None:
                key = (function.name, *function.args)
                self._add_change(TimedChange(time, key, value=value), node)
        else:
            positive = change.head != "not"
            inner = change if positive else change[-1]
            if not isinstance(inner, GroupNode) or not inner.head or inner.head in _LOGIC:
                message, hint = "(at TIME (p a b)) is expected here", "write one for each fact"
                source.error(node.at, "not-a-fact", message, hint)
                return
            atom = self._base_atom(inner)
            if atom is not None:
                self._add_change(TimedChange(time, (atom.name, *atom.args), positive), node)

    def _add_change(self, change: TimedChange, node: GroupNode) -> None:
        """Take a timed change; one that contradicts another of its instant is an error."""
        other = self._changes.setdefault((change.time, change.key), change)
        if other == change:
            self.timed_changes.append(change)
            return
        message = f"{change} contradicts {other}: the two happen at one time"
        self.scope.source.error(node.at, "duplicate-value", message, "remove one of the two")

    def _base_atom(self, node: GroupNode) -> Atom | None:
        """Return a fact that a state can hold: no derived predicate."""
        atom = read_atom(node, self.scope)
        if atom is not None and atom.name in self.scope.domain.derived:
            message = f"{quote(atom.name)} is derived: no initial state holds it"
            self.scope.source.error(node.at, "derived-predicate", message, "remove it")
            return None
        return atom

    def _fact(self, node: GroupNode) -> None:
        atom = self._base_atom(node)
        if atom is not None:
            self._add((atom.name, *atom.args), node)

    def _add(self, fact: Fact, node: GroupNode) -> None:
        if fact in self.facts:
            message = f"{quote(fact_text(fact))} stands twice"
            self.scope.source.warn(node.at, "duplicate-fact", message, "remove one of the two")
        self.facts.add(fact)
        if self.negative_facts:
            self._check_negative(fact, node)

    def _negative_fact(self, node: GroupNode) -> None:
        inner = node[1] if len(node) == 2 else None
        if isinstance(inner, GroupNode) and inner.head:
            atom = read_atom(inner, self.scope)
            if atom is not None:
                self.negative_facts.add((atom.name, *atom.args))
                self._check_negative((atom.name, *atom.args), node)
        else:
            message, hint = "(not (p a b)) is expected here", "what is not listed does not hold"
            self.scope.source.error(node.at, "not-a-fact", message, hint)

    def _check_negative(self, fact: FluentKey, node: GroupNode) -> None:
        if fact in self.facts and fact in self.negative_facts:
            message = f"{quote(str(Atom(fact[0], fact[1:])))} is both true and false"
            self.scope.source.error(node.at, "duplicate-value", message, "remove one of the two")

    def _value(self, node: GroupNode) -> None:
        source = self.scope.source
        if len(node) != 3:
            self._report_value(node)
            return
        if all(isinstance(part, WordNode) and part in self.scope.objects for part in node[1:]):
            message = "objects are not set equal"
            source.error(node.at, "not-a-fact", message, "remove it: an object equals itself only")
            return
        function = self.scope.plain_function(node[1])
        if function is None:
            if isinstance(node[2], GroupNode) and isinstance(node[1], WordNode):
                message, hint = "the function stands before its value", "write (= (f a) NUMBER)"
                source.error(node[1].at, "not-a-fact", message, hint)
                return
            function = read_function(node[1], self.scope)
            if function is None and self._is_predicate(node[1]):
                return
        value = self._number(node[2])
        if value is not None and function is not None:
            self._set((function.name, *function.args), value, node.at)

    def _is_predicate(self, node: ParseNode) -> bool:
        domain = self.scope.domain
        return isinstance(node, GroupNode) and node.head in domain.predicates

    def _report_value(self, node: GroupNode) -> None:
        hint = "write (= (f a) NUMBER)"
        if "-" in [part for part in node if isinstance(part, WordNode)]:
            hint = "the sign touches its number: -5"
        message = "(= (f a) NUMBER) is expected here"
        self.scope.source.error(node.at, "not-a-fact", message, hint)

    def _number(self, node: ParseNode) -> Number | None:
        value = to_number(node) if isinstance(node, WordNode) else None
        if value is None:
            _report_no_number(node, self.scope)
        return value

    def _set(self, key: FluentKey, value: Number, at: int) -> None:
        source, text = self.scope.source, quote(f"({' '.join(key)})")
        before = self.values.setdefault(key, value)
        if before != value:
            hint = f"it is {number_text(before)} before: remove one of the two"
            source.error(at, "duplicate-value", f"{text} gets a second value", hint)
        elif key in self.places:
            source.warn(at, "duplicate-fact", f"{text} is set twice", "remove one of the two")
        self.places[key] = at


def _report_no_number(node: ParseNode, scope: Scope) -> None:
    word = quote(node) if isinstance(node, WordNode) else "a group"
    if isinstance(node, WordNode) and node in scope.objects:
        message = f"{word} is an object, not a number"
        scope.source.error(node.at, "not-a-number", message, OBJECT_FLUENTS)
    else:
        cure = "write the number itself"
        if isinstance(node, WordNode):
            cure = decimal_cure(node) or cure
        scope.source.error(node.at, "bad-number", f"{word} is not a number", cure)


def _is_timed(part: ParseNode) -> bool:
    """Whether a part of ``(at 9 (open))`` is its time or its change."""
    return isinstance(part, GroupNode) or looks_numeric(part)


def _goal(
    section: GroupNode | None, root: GroupNode, scope: Scope
) -> tuple[Formula, tuple[Preference, ...]]:
    if section is None or len(section) < 2:
        at = root if section is None else section
        scope.source.error(at.at, "no-goal", "the problem has no goal", "add (:goal (and …))")
        return TRUE, ()
    if len(section) > 2:
        hint = "put an (and …) around all"
        if isinstance(section[1], WordNode):
            hint = f"write (:goal ({section[1]} …))"
            scope.source.error(section[1].at, "not-a-condition", "a goal is one condition", hint)
            return TRUE, ()
        scope.source.error(section[2].at, "stray-word", "a goal is one condition", hint)
    hard, preferences = read_preferences(section[1], scope)
    return read_formula(hard, scope), preferences


def _metric(section: GroupNode | None, scope: Scope) -> tuple[Expr | None, bool]:
    if section is None:
        return None, False
    if len(section) != 3 or section[1] not in _SENSES:
        message = "(:metric minimize EXPRESSION) or (:metric maximize EXPRESSION) is expected"
        scope.source.error(section.at, "bad-metric", message, _metric_cure(section))
        return None, False
    return read_expression(section[2], scope.knowing(TOTAL_TIME)), section[1] == "maximize"


def _metric_cure(section: GroupNode) -> str | None:
    word = section[1] if len(section) > 1 else None
    if word in _SENSES:
        return (
            f"write (:metric {word} (+ A B))" if len(section) > 3 else f"write (:metric {word} (f))"
        )
    if isinstance(word, GroupNode) and word.head not in _SENSES:
        return f"write (:metric minimize ({word.head} …))"
    if isinstance(word, GroupNode) and word.head in _SENSES:
        return f"write (:metric {word.head} …): the word takes no parentheses of its own"
    if isinstance(word, WordNode) and word not in _SENSES:
        short = next((sense for sense in _SENSES if sense.startswith(word)), None)
        return f"write {short}" if short else nearest(word, _SENSES)
    return None
