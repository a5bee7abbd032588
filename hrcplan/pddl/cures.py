"""What is written as in other languages, or at the wrong place: reported with its cure."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

from hrcplan.core.text import cut, plural, quote
from hrcplan.pddl.foreign import EFFECTS_ONLY, FOREIGN, OF_FACTS, PREFIXES, infix_cure
from hrcplan.pddl.reader import GroupNode, ParseNode, WordNode
from hrcplan.pddl.scope import Scope

COMPARISONS = frozenset(["<", "<=", "=", ">=", ">"])
ARITHMETIC = frozenset("+-*/")
UNSUPPORTED = {
    "preference": ("preferences inside of another condition than and, forall",
                   "put it into the (and …) of the goal or of the precondition"),
    "is-violated": ("preferences outside of the metric", "move it into (:metric …)"),
    "probabilistic": ("probabilistic effects", "write the effect that is meant to happen"),
    "oneof": ("non-deterministic effects", "write one action for each of them"),
    "unknown": ("unknown facts of contingent planning", "a fact that is not listed is false"),
}  # fmt: skip
"""What hrcplan does not read, and how to write it."""

OF_TRAJECTORIES = frozenset([
    "always", "sometime", "within", "at-most-once", "sometime-after", "sometime-before",
    "always-within", "hold-during", "hold-after",
])  # fmt: skip
_ONE_BODY = frozenset(["when", "forall", "exists", "not"])  # whose last part is one group
_LOGIC = _ONE_BODY | {"and", "or", "imply"}
MAX_WORDS = 60
"""Characters of a file that a hint repeats."""
_FORMS = {
    "when": "(when CONDITION EFFECT)",
    "forall": "(forall (?x - type) …)",
    "exists": "(exists (?x - type) …)",
    "not": "(not (p))",
    **dict.fromkeys(("increase", "decrease", "assign"), "(increase (f) AMOUNT)"),
    **dict.fromkeys(("scale-up", "scale-down"), "(scale-up (f) FACTOR)"),
}


def groups_of(parts: Iterable[ParseNode], scope: Scope, kind: str) -> Iterator[GroupNode]:
    """Yield the parts of a list that are groups; each run of loose words is one error.

    A group that touches the word before it, as in ``idle(?a)``, belongs to that word.
    """
    run: list[ParseNode] = []
    for part in parts:
        if isinstance(part, WordNode):
            run.append(part)
        elif run:
            report_loose([*run, part], scope, kind)
            if not _touches(run[-1], part):
                yield part
            run = []
        else:
            yield part
    if run:
        report_loose(run, scope, kind)


def report_loose(nodes: Sequence[ParseNode], scope: Scope, kind: str) -> None:
    """Report what has no head: bare words, perhaps before a group, or a group of groups."""
    article = "an" if kind == "effect" else "a"
    message = f"{article} {kind} such as (p ?x) is expected here"
    code, cure = f"not-{article}-{kind}", _loose_cure(nodes, kind)
    scope.source.error(nodes[0].at, code, message, cure)


def _loose_cure(nodes: Sequence[ParseNode], kind: str) -> str:
    word, following = nodes[0], nodes[-1]
    if isinstance(word, GroupNode):
        hint = infix_cure(word, kind == "effect")
        if hint is None and len(word) == 1:
            hint = "one pair of parentheses is too much"
        if hint is None and kind == "fact":
            return "facts stand one after the other, each as (p a b)"
        return hint or f"put the {kind}s in one (and …)"
    is_before_group = isinstance(following, GroupNode)
    hint = PREFIXES.get(str(word)) if is_before_group else None
    hint = hint or FOREIGN.get(str(word))
    if hint is None and word in _LOGIC:
        hint = f"the parenthesis stands first: ({word} (p ?x))"
    if hint is None and word in COMPARISONS:
        hint = f"the operator stands first: ({word} A B)"
    if hint is None and isinstance(following, GroupNode) and _touches(nodes[-2], following):
        return _call_cure(nodes[-2], following)
    words = " ".join(part for part in nodes if isinstance(part, WordNode))
    return hint or f"write ({cut(words, MAX_WORDS)})"


def _call_cure(word: ParseNode, group: GroupNode) -> str:
    inside = " ".join(part if isinstance(part, WordNode) else "…" for part in group)
    return f"the parenthesis stands first: ({cut(f'{word} {inside}', MAX_WORDS)})"


def _touches(word: ParseNode, node: ParseNode) -> bool:
    return isinstance(word, WordNode) and word.at + len(word) == node.at


def is_foreign(node: GroupNode, scope: Scope) -> bool:
    """Report an operator of another language, with what PDDL writes instead."""
    head = str(node.head)
    if head in scope.domain.predicates or head in scope.domain.functions:
        return _is_infix(node, scope)
    if head in EFFECTS_ONLY:
        message = f"{quote(head)} cannot stand here"
        scope.source.error(node[0].at, "not-a-condition", message, EFFECTS_ONLY[head])
        return True
    if head in OF_TRAJECTORIES:
        message = f"{quote(head)} belongs into (:constraints …)"
        scope.source.error(
            node[0].at, "not-a-condition", message, f"write (:constraints ({head} …))"
        )
        return True
    cure = FOREIGN.get(head)
    takes_terms = not any(isinstance(part, GroupNode) for part in node[1:])
    if cure is None or (takes_terms and head in OF_FACTS):
        return _is_infix(node, scope)
    scope.source.error(node[0].at, "foreign-operator", f"PDDL has no {quote(head)}", cure)
    return True


def _is_infix(node: GroupNode, scope: Scope) -> bool:
    """Report an operator between its operands."""
    hint = infix_cure(node)
    if hint is None or node[1] in scope.objects:
        return False
    message = "in PDDL the operator stands first"
    scope.source.error(node[1].at, "foreign-operator", message, hint)
    return True


def is_unsupported(node: GroupNode, scope: Scope) -> bool:
    """Report a construct that hrcplan does not know, unless its word is a predicate here."""
    declared = node.head in scope.domain.predicates or node.head in scope.domain.functions
    if node.head not in UNSUPPORTED or declared:
        return False
    name, hint = UNSUPPORTED[node.head]
    scope.source.error(node.at, "unsupported", f"{name} are not supported", hint)
    return True


def has_parts(node: GroupNode, n_parts: int, scope: Scope) -> bool:
    """Whether a group has ``n_parts`` elements after its head; if not, that is an error."""
    if len(node) == n_parts + 1:
        return True
    message = f"{quote(node.head)} takes {plural(n_parts, 'part')}, not {len(node) - 1}"
    scope.source.error(node.at, "wrong-arity", message, _parts_cure(node, n_parts))
    return False


def _parts_cure(node: GroupNode, n_parts: int) -> str:
    """Return how to write a group that has too many parts or too few."""
    head = node.head
    if head in ("forall", "exists") and len(node) > 1 and isinstance(node[1], WordNode):
        return f"write ({head} (?x - type) …), the variables in parentheses"
    if head in _ONE_BODY and len(node) > n_parts + 1:
        return "put them in one (and …)"
    for word, group in pairwise(node[1:]):
        if isinstance(group, GroupNode) and _touches(word, group):
            return _call_cure(word, group)
    if any(part in ARITHMETIC for part in node[1:] if isinstance(part, WordNode)):
        return "the operator stands first: (+ A B)"
    if head in COMPARISONS and len(node) == 4:
        return f"write (and ({head} A B) ({head} B C))"
    return f"write {_FORMS.get(head, f'({head} A B)')}"
