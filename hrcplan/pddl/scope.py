"""Names that are known at one place of a file: types, terms, predicates, functions.

Looks a name up, reports an unknown one with a hint, and checks number and types of arguments.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence, Set
from functools import cached_property
from itertools import count, pairwise

from hrcplan.core.numbers import fraction_of, number_text, to_number
from hrcplan.core.records import field, record, replace
from hrcplan.core.text import cut, plural, quote
from hrcplan.pddl.foreign import FOREIGN
from hrcplan.pddl.model import OBJECT, TOTAL_TIME, Atom, Domain, Function, Param, Signature
from hrcplan.pddl.reader import FlatNode, GroupNode, ParseNode, WordNode
from hrcplan.pddl.source import SourceText

_BINDING = "list it in :parameters, or in an (exists …) or (forall …) around this"
_TIME_WORDS = frozenset(["makespan", "totaltime", "total_time", "time", "duration", "length",
                         "plan-length", "steps"])  # fmt: skip
"""What a metric calls the time of a plan in other languages."""


@record
class Scope:
    """A domain, the objects known so far, and what is bound here.

    ``numbers`` are the special values that only some places know: ``?duration`` in a durative
    action, ``total-time`` in a metric. ``renames`` are the variables of quantifiers that are also
    bound outside, and what they are called in the model; ``preferences`` the names that a
    metric may ask about (None outside of a metric); ``derived`` the predicates that no action
    may change.
    """

    source: SourceText
    domain: Domain
    objects: Mapping[str, str]
    variables: Mapping[str, tuple[str, ...]]
    numbers: frozenset[str] = frozenset()
    renames: Mapping[str, str] = field(default_factory=dict)
    preferences: Set[str] | None = None
    derived: Set[str] = frozenset()

    @cached_property
    def _atoms(self) -> dict[str, Atom | None]:
        """What groups of words are here, by their text."""
        return {}

    def binding(self, params: Sequence[Param]) -> Scope:
        """Return this scope with further variables."""
        bound = {**self.variables, **{p.name: p.types for p in params}}
        return self._with(bound, self.renames)

    def _with(self, variables: Mapping[str, tuple[str, ...]], renames: Mapping[str, str]) -> Scope:
        """Return a copy with other variables; it takes less time than `replace`."""
        return Scope(self.source, self.domain, self.objects, variables, self.numbers, renames,
                     self.preferences, self.derived)  # fmt: skip

    def quantifying(self, params: Sequence[Param], at: int) -> tuple[tuple[Param, ...], Scope]:
        """Return the variables of a quantifier and the scope in it.

        A variable that is bound outside too gets another name, so that what stands outside never
        means the inner one when the model pulls quantifiers together.
        """
        names = set(self.variables)
        renames = dict(self.renames)
        inner: list[Param] = []
        for param in params:
            name = param.name
            if name in self.variables:
                message = f"variable {quote(name)} is bound outside of this quantifier too"
                self.source.warn(at, "shadowed-variable", message, "give it another name")
                name = next(n for i in count(2) if (n := f"{name}-{i}") not in names)
            renames[param.name] = name
            names.add(name)
            inner.append(Param(name, param.types))
        bound = {p.name: p.types for p in (*params, *inner)}
        return tuple(inner), self._with({**self.variables, **bound}, renames)

    def term(self, word: str) -> str:
        """Return the name of a variable or object in the model."""
        return self.renames.get(word, str(word))

    def knowing(self, number: str) -> Scope:
        """Return this scope with a further special value."""
        return replace(self, numbers=self.numbers | {number})

    def is_atom(self, node: GroupNode) -> bool:
        """Return whether a group is a declared predicate with words, whatever its name.

        So is ``(when ?x)``, if there is such a predicate; ``(and)`` and ``(or)`` never are.
        """
        head = node.head
        if head not in self.domain.predicates:
            return False
        words = all(isinstance(part, WordNode) for part in node)
        return words and (len(node) > 1 or head not in ("and", "or"))

    def plain_atom(self, node: ParseNode) -> Atom | None:
        """Return the atom that a group is; None if anything about it needs a second look.

        Most groups of a file are atoms without a fault, so they take this short way; an action
        says most of its atoms twice.
        """
        if not isinstance(node, FlatNode):
            return None
        text, atoms = node.text, self._atoms
        if text not in atoms:
            term = self._plain(node, self.domain.predicates)
            is_plain = term is not None and (len(term) > 1 or term[0] not in ("and", "or"))
            atoms[text] = Atom(term[0], term[1:]) if term and is_plain else None
        return atoms[text]

    def plain_function(self, node: ParseNode) -> Function | None:
        """Return the function that a group is; None if anything about it needs a second look."""
        term = self._plain(node, self.domain.functions) if isinstance(node, FlatNode) else None
        return None if term is None else Function(term[0], term[1:])

    def _plain(self, node: FlatNode, signatures: Mapping[str, Signature]) -> tuple[str, ...] | None:
        """Return the words of a group if they are declared and fit each other."""
        name, *args = words = node.words()
        signature = signatures.get(name)
        if signature is None or len(args) != len(signature.params) or self.renames:
            return None
        for term, param in zip(args, signature.params, strict=True):
            types: tuple[str, ...] | None
            if term[0] == "?":
                types = self.variables.get(term)
            else:
                kind = self.objects.get(term)
                types = None if kind is None else (kind,)
            if types is None or (
                types != param.types
                and not (len(types) == 1 and self.domain.is_a(types[0], param.types))
            ):
                return None
        return tuple(words)

    def types_of(self, term: WordNode) -> tuple[str, ...] | None:
        """Return the types of a variable or object; None, with an error, if it is unknown."""
        if term.startswith("?"):
            if term not in self.variables:
                message = f"variable {quote(term)} is not bound here"
                variable = next((v for v in self.variables if v.startswith(f"{term}-")), None)
                hint = (
                    f"spaces are missing around the '-' of {quote(variable)}" if variable else None
                )
                variables = self.variables
                self.source.unknown(term.at, "unbound", message, term, variables, hint, _BINDING)
            return self.variables.get(term)
        if term not in self.objects:
            if term in self.source.unknown_types:  # it was read as the type of others
                return None
            message = f"there is no object {quote(term)}"
            hint, cure = self._other_meaning(term), self._object_cure()
            self.source.unknown(term.at, "unknown-object", message, term, self.objects, hint, cure)
            return None
        return (self.objects[term],)

    def _other_meaning(self, term: WordNode) -> str | None:
        """Return a hint where an unknown object is a word of another kind."""
        variable = f"?{term.lstrip('$@%')}"
        if variable in self.variables:
            return f"did you mean {quote(variable)}?"
        if looks_numeric(term):
            return "arguments are objects, not numbers"
        joined = next((name for name in self.objects if name.startswith(f"{term}-")), "")
        if joined.removeprefix(f"{term}-") in self.domain.types:
            return f"spaces are missing around the '-' of {quote(joined)}"
        if term in self.domain.types:
            return f"it is a type: write a variable of it, such as ?x, declared as ?x - {term}"
        if term in self.domain.functions:
            return "it is a function, and no number can be an argument"
        return None

    def _object_cure(self) -> str:
        is_domain = self.source.path == self.domain.path
        return f"declare it in {'(:constants …)' if is_domain else '(:objects …)'}"

    def arguments(self, group: GroupNode, signature: Signature) -> tuple[str, ...] | None:
        """Return the arguments of ``group``; None, with errors, if they do not fit."""
        terms = [term for term in group[1:] if isinstance(term, WordNode)]
        if len(terms) < len(group) - 1:
            inner = next(t for t in group[1:] if isinstance(t, GroupNode))
            message = "a variable or object is expected here"
            self.source.error(inner.at, "not-a-term", message, self._bare_term(inner))
            return None
        if len(terms) != len(signature.params):
            expectation = (
                f"{quote(signature.name)} takes {plural(len(signature.params), 'argument')}"
            )
            message, hint = f"{expectation}, not {len(terms)}", f"declared as {signature}"
            for sign, name in pairwise(terms):
                if sign == "?":
                    hint = f"write ?{name} without a space"
            self.source.error(group.at, "wrong-arity", message, hint)
            return None
        fits = [self._fits(t, p) for t, p in zip(terms, signature.params, strict=True)]
        if not all(fits):
            return None
        return tuple(map(self.term, terms)) if self.renames else tuple(map(str, terms))

    def _fits(self, term: WordNode, param: Param) -> bool:
        types = self.types_of(term)
        if types is None:
            return False
        if types == param.types:  # most are, and files have many
            return True
        is_a = self.domain.is_a
        if any(is_a(t, param.types) for t in types) or not self._declares(*types, *param.types):
            return True
        have, want = quote(" or ".join(types)), quote(" or ".join(param.types))
        message = f"{quote(term)} is {have}, not {want}"
        if any(is_a(wanted, types) for wanted in param.types):  # it may be one, as others read it
            self.source.warn(term.at, "wrong-type", message, f"declare it as {want}")
            return True
        hint = f"declare it as {want}, or {have} below {want} in (:types …)"
        self.source.error(term.at, "wrong-type", message, hint)
        return False

    def _declares(self, *types: str) -> bool:
        """Whether all types are known: one that is not has been reported where it is named."""
        return all(t == OBJECT or t in self.domain.types for t in types)

    def signature(self, word: WordNode, kind: str) -> Signature | None:
        """Return the declared predicate or function; None, with an error, if there is none."""
        is_predicate = kind == "predicate"
        names, other = self.domain.predicates, self.domain.functions
        if not is_predicate:
            names, other = other, names
        if word in names:
            return names[word]
        code = f"unknown-{kind}"
        if self.source.is_reported(code, word):
            return None
        if word == TOTAL_TIME:
            hint = "remove it; a cost that actions increase is called total-cost"
            self.source.error(word.at, code, "total-time is known in the metric only", hint)
        elif word in other:
            wrong, hint = "predicate", "leave the number out"
            if is_predicate:
                wrong, hint = "function", f"write (= ({cut(word, 40)} …) NUMBER)"
            self.source.error(word.at, code, f"{quote(word)} is a {wrong}, not a {kind}", hint)
        else:
            message = f"{kind} {quote(word)} is not declared"
            cure = FOREIGN.get(word) or _negated(word, names)
            if TOTAL_TIME in self.numbers and word in _TIME_WORDS:
                cure = "write (total-time)"
            otherwise = f"declare it in (:{kind}s …)"
            self.source.unknown(word.at, code, message, word, names, cure, otherwise)
        return None

    def _bare_term(self, group: GroupNode) -> str | None:
        """Return a hint for a term in parentheses, or for an argument list such as ``p(?x)``."""
        if group.head in self.domain.predicates or group.head in self.domain.functions:
            return "arguments are variables and objects: write one condition after the other"
        if all(isinstance(word, WordNode) for word in group):
            inside = " ".join(str(word) for word in group)
            return f"write {inside} without parentheses" if inside else "leave the parentheses out"
        return None


def _negated(word: str, names: Collection[str]) -> str | None:
    """Return a hint for a name with a sign for "not" before it."""
    for prefix in ("!", "~", "-", "¬", "not-", "not_"):
        if word.startswith(prefix) and word.removeprefix(prefix) in names:
            return f"write (not ({word.removeprefix(prefix)} …))"
    return None


def looks_numeric(word: str) -> bool:
    """Whether a word was meant as a number: it starts with a digit, or a sign or dot and one."""
    return word.lstrip("+-.")[:1].isdigit()


def decimal_cure(word: str) -> str | None:
    """Return a hint for a number with a comma, a unit, or as a fraction."""
    plain = word.replace(",", ".")
    if plain != word and to_number(plain) is not None:
        return f"write {plain}"
    fraction, unit = fraction_of(word), word.rstrip("abcdefghijklmnopqrstuvwxyz%")
    if fraction is not None and "/" in word:
        return f"write {number_text(fraction)}"
    return f"write {unit}" if unit != word and to_number(unit) is not None else None
