"""What PDDL files say, as immutable values: domains, problems, formulas, expressions.

Names are lower case. A *fact* is a tuple ``(predicate, *objects)``. ``str()`` of every value
is PDDL again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property

from hrcplan.core.numbers import Number, number_text
from hrcplan.core.records import field, record, replace
from hrcplan.core.text import cut, plural

Fact = tuple[str, ...]
FluentKey = tuple[str, ...]
"""A ground function: ``(name, *objects)``."""

OBJECT = "object"
TOTAL_COST = "total-cost"
TOTAL_TIME = "total-time"
DURATION = "?duration"
CONTINUOUS = "#t"
"""The time that has passed since a process or an action with continuous effects began."""
VIOLATED = "is-violated"
"""The function, of a preference's name, that a metric reads: how often it is violated."""


def fact_text(fact: Fact) -> str:
    """Return ``(name arg …)``."""
    return f"({' '.join(fact)})"


@record
class Param:
    """A parameter (or variable) and the types it may have; several mean ``(either …)``."""

    name: str
    types: tuple[str, ...] = (OBJECT,)

    def __str__(self) -> str:
        kind = self.types[0] if len(self.types) == 1 else f"(either {' '.join(self.types)})"
        return f"{self.name} - {kind}"


@record
class Signature:
    """A declared predicate or function."""

    name: str
    params: tuple[Param, ...]

    def __str__(self) -> str:
        return _group(self.name, *self.params)


@record
class Atom:
    """A predicate applied to variables and objects."""

    name: str
    args: tuple[str, ...]

    def __str__(self) -> str:
        return _group(self.name, *self.args)


@record
class Equal:
    """Two terms that denote the same object."""

    left: str
    right: str

    def __str__(self) -> str:
        return f"(= {self.left} {self.right})"


@record
class Function:
    """A numeric function applied to terms; also ``total-time`` and ``?duration``."""

    name: str
    args: tuple[str, ...] = ()

    def __str__(self) -> str:
        return self.name if self.name in (DURATION, CONTINUOUS) else _group(self.name, *self.args)


@record
class Constant:
    """A number."""

    value: Number

    def __str__(self) -> str:
        return number_text(self.value)


@record
class Arithmetic:
    """``+ - * /`` over expressions."""

    op: str
    parts: tuple[Expr, ...]

    def __str__(self) -> str:
        return _group(self.op, *self.parts)


Expr = Function | Constant | Arithmetic


@record
class Compare:
    """A numeric condition: ``< <= = >= >``."""

    op: str
    left: Expr
    right: Expr

    def __str__(self) -> str:
        return f"({self.op} {self.left} {self.right})"


@record
class Not:
    """Negation."""

    body: Formula

    def __str__(self) -> str:
        return f"(not {self.body})"


@record
class And:
    """Conjunction; empty means true."""

    parts: tuple[Formula, ...] = ()

    def __str__(self) -> str:
        return _group("and", *self.parts)


@record
class Or:
    """Disjunction; empty means false."""

    parts: tuple[Formula, ...] = ()

    def __str__(self) -> str:
        return _group("or", *self.parts)


@record
class Quantified:
    """``forall`` or ``exists``."""

    universal: bool
    params: tuple[Param, ...]
    body: Formula

    def __str__(self) -> str:
        word = "forall" if self.universal else "exists"
        return f"({word} {_group(*self.params)} {self.body})"


Formula = Atom | Equal | Compare | Not | And | Or | Quantified
TRUE = And()


@record
class Condition:
    """A formula and when it must hold: ``start``, ``all`` (over all) or ``end``."""

    when: str
    formula: Formula


@record
class Effect:
    """One change: ``add``/``delete`` an atom, or ``assign``/``increase``/… a function.

    ``when`` is ``start`` or ``end``, or ``all`` for a number that changes while time passes.

    ``params`` are the variables of an enclosing ``forall``; ``condition`` is that of an
    enclosing ``when`` (``TRUE`` if there is none), read when the effect happens, and
    ``start_condition`` one that an effect at the end reads at the start of its action.
    """

    when: str
    kind: str
    target: Atom | Function
    value: Expr | None = None
    params: tuple[Param, ...] = ()
    condition: Formula = TRUE
    start_condition: Formula = TRUE

    def __str__(self) -> str:
        match self.kind:
            case "add":
                text = str(self.target)
            case "delete":
                text = f"(not {self.target})"
            case _:
                text = f"({self.kind} {self.target} {self.value})"
        if self.condition != TRUE:
            text = f"(when {self.condition} {text})"
        return f"(forall {_group(*self.params)} {text})" if self.params else text


@record
class Preference:
    """A condition that should hold: ``when`` is empty in a goal, else as in a `Condition`.

    ``params`` are the variables of an enclosing ``forall``: each instance counts by itself.
    """

    name: str
    formula: Formula
    params: tuple[Param, ...] = ()
    when: str = ""


@record
class Trajectory:
    """One condition on the states that a plan goes through, such as ``(within 5 (p))`` (PDDL 3)."""

    op: str
    times: tuple[Number, ...]
    parts: tuple[Formula, ...]


@record
class Constraint:
    """Trajectory conditions, for all instances of ``params``; a named one is a preference."""

    trajectories: tuple[Trajectory, ...]
    params: tuple[Param, ...] = ()
    preference: str = ""


@record
class Axiom:
    """A derived predicate (PDDL 2.2): it holds of ``params`` wherever ``body`` does."""

    name: str
    params: tuple[Param, ...]
    body: Formula


@record
class TimedChange:
    """A timed initial literal: at ``time`` a fact comes or goes, or a function gets a value."""

    time: Number
    key: Fact
    positive: bool = True
    value: Number | None = None

    @property
    def literal(self) -> str:
        """The literal without its time, as PDDL."""
        text = fact_text(self.key)
        if self.value is not None:
            return f"(= {text} {number_text(self.value)})"
        return text if self.positive else f"(not {text})"

    def __str__(self) -> str:
        return f"(at {number_text(self.time)} {self.literal})"


@record
class Action:
    """An action schema; an instantaneous one has all its conditions and effects at start."""

    name: str
    params: tuple[Param, ...]
    conditions: tuple[Condition, ...]
    effects: tuple[Effect, ...]
    durative: bool = False
    durations: tuple[tuple[str, Expr], ...] = ()
    preferences: tuple[Preference, ...] = ()

    @property
    def fixed_duration(self) -> Expr | None:
        """The duration, if the action sets exactly one with ``=``; else None."""
        values = [expression for op, expression in self.durations if op == "="]
        return values[0] if len(values) == 1 else None


@record
class Note:
    """A ``;; hrcplan:`` comment of a domain or a problem: what PDDL cannot hold.

    ``success ACTION p``: the probability that an interaction has its effect.
    ``range FUNCTION low high``: the values that a function takes.
    ``say ACTION words, …`` and ``call OBJECT words, …``: what people call an action or an object
    (or every object of a type).
    ``show NAME words``: how pages draw facts of a predicate, an object, or every object of a type.
    """

    kind: str
    name: str
    numbers: tuple[Number, ...] = ()
    phrases: tuple[str, ...] = ()

    def __str__(self) -> str:
        values = [*map(number_text, self.numbers)]
        return " ".join([self.kind, self.name, *values, ", ".join(self.phrases)]).rstrip()


@record
class Domain:
    """A planning domain, with the file it came from and its ``;; hrcplan:`` notes.

    ``processes`` and ``events`` (PDDL+) happen by themselves wherever their conditions hold.
    """

    name: str
    requirements: tuple[str, ...] = ()
    types: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    constants: Mapping[str, str] = field(default_factory=dict)
    predicates: Mapping[str, Signature] = field(default_factory=dict)
    functions: Mapping[str, Signature] = field(default_factory=dict)
    actions: tuple[Action, ...] = ()
    axioms: tuple[Axiom, ...] = ()
    processes: tuple[Action, ...] = ()
    events: tuple[Action, ...] = ()
    constraints: tuple[Constraint, ...] = ()
    notes: tuple[Note, ...] = ()
    path: str = ""

    def __repr__(self) -> str:
        return f"<Domain {cut(self.name, 80)}: {plural(len(self.actions), 'action')}>"

    @cached_property
    def _ancestors(self) -> dict[str, frozenset[str]]:
        """Types already asked for, with themselves and all that are above them."""
        return {}

    def _above(self, name: str) -> frozenset[str]:
        ancestors = self._ancestors.get(name)
        if ancestors is None:
            above = {name, OBJECT}
            waiting = [name]
            while waiting:
                new = set(self.types.get(waiting.pop(), ())) - above
                above |= new
                waiting.extend(new)
            ancestors = self._ancestors[name] = frozenset(above)
        return ancestors

    def is_a(self, name: str, types: tuple[str, ...]) -> bool:
        """Return whether type ``name`` is one of ``types`` or below one of them."""
        return not self._above(name).isdisjoint(types)

    def success(self, action: str) -> Number:
        """Return the probability that an action has its effect: its ``success`` note, else 1."""
        return next((n.numbers[0] for n in self._notes("success", action)), 1)

    def value_range(self, function: str) -> tuple[Number, Number] | None:
        """Return the least and greatest value of a function: its ``range`` note, else None."""
        return next(((n.numbers[0], n.numbers[1]) for n in self._notes("range", function)), None)

    def _notes(self, kind: str, name: str) -> Iterator[Note]:
        return (note for note in self.notes if (note.kind, note.name) == (kind, name))

    @cached_property
    def schemas(self) -> Mapping[str, Action]:
        """The actions by name."""
        return {action.name: action for action in reversed(self.actions)}

    def action(self, name: str) -> Action:
        """Return the action of a name.

        Raises:
            KeyError: if there is none.
        """
        return self.schemas[name]

    @cached_property
    def is_temporal(self) -> bool:
        """Whether any action has a duration."""
        return any(action.durative for action in self.actions)

    @cached_property
    def is_continuous(self) -> bool:
        """Whether numbers change while time passes: by processes, events, or effects of ``#t``."""
        effects = (effect for action in self.actions for effect in action.effects)
        return bool(self.processes or self.events) or any(e.when == "all" for e in effects)

    @cached_property
    def derived(self) -> frozenset[str]:
        """Predicates that axioms define: no state holds them, they follow from it."""
        return frozenset(axiom.name for axiom in self.axioms)

    @cached_property
    def sources(self) -> Mapping[str, frozenset[str]]:
        """The names of what each derived predicate depends on, whether directly or not."""
        from hrcplan.pddl.walks import lifted_names

        names: dict[str, frozenset[str]] = dict.fromkeys(self.derived, frozenset())
        for axiom in self.axioms:
            names[axiom.name] |= frozenset(lifted_names(axiom.body))
        while True:
            more = {
                name: below.union(*(names[other] for other in below if other in names))
                for name, below in names.items()
            }
            if more == names:
                return names
            names = more

    @cached_property
    def changed_functions(self) -> frozenset[str]:
        """Functions that some action changes, ``total-cost`` included if it is one of them."""
        return frozenset(
            effect.target.name
            for action in self.actions
            for effect in action.effects
            if isinstance(effect.target, Function)
        )


@record
class Problem:
    """A planning problem: objects, initial state, goal and metric of one domain.

    ``timed`` are changes that come by themselves, in order of time; ``preferences`` those of the
    goal, which a plan may miss; ``constraints`` are about the states on the way to it.
    """

    name: str
    domain: Domain
    objects: Mapping[str, str] = field(default_factory=dict)
    facts: frozenset[Fact] = frozenset()
    values: Mapping[FluentKey, Number] = field(default_factory=dict)
    goal: Formula = TRUE
    metric: Expr | None = None
    maximize: bool = False
    timed: tuple[TimedChange, ...] = ()
    preferences: tuple[Preference, ...] = ()
    constraints: tuple[Constraint, ...] = ()
    notes: tuple[Note, ...] = ()
    path: str = ""

    def __repr__(self) -> str:
        counts = f"{plural(len(self.all_objects), 'object')}, {plural(len(self.facts), 'fact')}"
        return f"<Problem {cut(f'{self.domain.name}/{self.name}', 120)}: {counts}>"

    @cached_property
    def all_objects(self) -> dict[str, str]:
        """Objects and the domain's constants, with their types."""
        return {**self.domain.constants, **self.objects}

    def objects_of(self, types: tuple[str, ...]) -> tuple[str, ...]:
        """Return the objects of any of ``types``, in the order in which they are declared."""
        names = self._objects_of.get(types)
        if names is None:
            is_a = self.domain.is_a
            names = tuple(o for o, t in self.all_objects.items() if is_a(t, types))
            self._objects_of[types] = names
        return names

    def object_set(self, types: tuple[str, ...]) -> frozenset[str]:
        """Return the objects of any of ``types``."""
        names = self._object_sets.get(types)
        if names is None:
            names = self._object_sets[types] = frozenset(self.objects_of(types))
        return names

    @cached_property
    def _object_sets(self) -> dict[tuple[str, ...], frozenset[str]]:
        """Objects by the types asked for already, as sets."""
        return {}

    @cached_property
    def _objects_of(self) -> dict[tuple[str, ...], tuple[str, ...]]:
        """Objects by the types asked for already: quantifiers ask for the same over and over."""
        return {}

    def with_values(self, values: Mapping[FluentKey, Number]) -> Problem:
        """Return this problem with some function values of the initial state replaced."""
        return replace(self, values={**self.values, **values})

    @cached_property
    def agents(self) -> tuple[str, ...]:
        """Objects of type ``agent`` or below; empty if the domain has no such type."""
        return self.objects_of(("agent",)) if "agent" in self.domain.types else ()


def _group(*parts: str | Formula | Expr | Param) -> str:
    return f"({' '.join(map(str, parts))})"
