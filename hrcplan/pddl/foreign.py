"""Operators of other languages, and what PDDL writes instead."""

from __future__ import annotations

from hrcplan.pddl.reader import GroupNode, WordNode

_INSTEAD = {
    "=": "== eq equal equals is",
    "(not (= …))": "!= <> neq not= not-equal ≠",
    "and": "&& ∧ &",
    "or": "|| \u2228 |",
    "not": "! ~ ¬",
    "imply": "implies -> →",
    "<": "lt less less-than smaller",
    ">": "gt greater greater-than",
    "<=": "le leq lte =< ≤",
    ">=": "ge geq gte ≥",
    "forall": "for-all foreach for every all each ∀",
    "exists": "there-exists exist some any ∃",
    "(not (and …))": "nand",
    "(not (or …))": "nor",
    "(or (and A (not B)) (and (not A) B))": "xor",
    "(and (imply A B) (imply B A))": "iff <=> <->",
    "(increase (f) AMOUNT)": "+= inc increment ++",
    "(decrease (f) AMOUNT)": "-= dec decrement",
    "(assign (f) VALUE)": ":= <- ← set change update",
    "(scale-up (f) FACTOR)": "*= scale multiply",
    "(not (p))": "del delete remove",
}
FOREIGN = {
    word: f"write {right} instead" for right, words in _INSTEAD.items() for word in words.split()
} | {
    "=>": "write (imply A B) for conditions, >= for numbers",
    "if": "write (imply …) in a condition, (when CONDITION EFFECT) in an effect",
    "/=": "write (not (= …)) in a condition, (scale-down (f) FACTOR) in an effect",
    "add": "an effect such as (p) adds the fact",
    "true": "write (and), which always holds",
    "false": "write (or), which never holds",
    "nil": "write ()",
    "--": "a comment of PDDL begins with ;",
}
"""Each operator of other languages with a hint."""

EFFECTS_ONLY = {
    "when": "write (imply A B)",
    **dict.fromkeys(
        ("increase", "decrease", "assign", "scale-up", "scale-down"), "move it into :effect"
    ),
    "minimize": "write (:metric minimize …)",
    "maximize": "write (:metric maximize …)",
}
"""Words of PDDL that no condition has, with a hint."""

NO_ARITHMETIC = frozenset(
    [
        "%",
        "^",
        "**",
        "mod",
        "pow",
        "abs",
        "min",
        "max",
        "sqrt",
        "floor",
        "ceil",
        "round",
        "exp",
        "log",
        "sin",
        "cos",
        "tan",
    ]
)
"""Functions of other languages; the numbers of PDDL know the four operations."""

PREFIXES = {"-": "write (not (p))", "!": "write (not (p))", "~": "write (not (p))"}
"""What other languages write before a fact that is taken away."""

OF_FACTS = frozenset(word for word in FOREIGN if word.isascii() and word[0].isalpha()) - {
    "not=", "eq", "equal", "equals", "neq", "not-equal", "gt", "lt", "ge", "le", "true", "false",
    "nil",
}  # fmt: skip
"""Foreign words that have groups as operands; with objects they are undeclared predicates."""

_INFIX = frozenset(["=", "<", ">", "<=", ">=", "==", "!=", "<>", "+", "-", "*", "/", "+=", "-=",
                    "*=", ":=", "&&", "||", "and", "or"])  # fmt: skip


def infix_cure(group: GroupNode, is_effect: bool = False) -> str | None:
    """Return how to write a group with an operator between two operands; None if it has none.

    >>> group = GroupNode(0)
    >>> group.extend(WordNode(text) for text in ("f", ">", "3"))
    >>> infix_cure(group)
    'write (> A B)'
    """
    operator = group[1] if len(group) == 3 else None
    if not isinstance(operator, WordNode) or operator not in _INFIX:
        return None
    if is_effect and operator == "=":
        return "write (assign (f) VALUE)"
    return FOREIGN.get(str(operator), f"write ({operator} A B)")
