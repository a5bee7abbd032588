"""Operators of other languages, and what PDDL writes instead."""

from __future__ import annotations

from hrcplan.pddl.reader import GroupNode, WordNode

FOREIGN = {
    "==": "write = instead",
    "!=": "write (not (= …)) instead",
    "<>": "write (not (= …)) instead",
    "&&": "write and instead",
    "||": "write or instead",
    "!": "write not instead",
    "implies": "write imply instead",
    "=>": "write imply instead",
    "->": "write imply instead",
    "if": "write (imply …) in a condition, (when CONDITION EFFECT) in an effect",
    "+=": "write (increase (f) AMOUNT) instead",
    "-=": "write (decrease (f) AMOUNT) instead",
    ":=": "write (assign (f) VALUE) instead",
    "set": "write (assign (f) VALUE) instead",
    "*=": "write (scale-up (f) FACTOR) instead",
    "/=": "write (not (= …)) in a condition, (scale-down (f) FACTOR) in an effect",
    "inc": "write (increase (f) AMOUNT) instead",
    "dec": "write (decrease (f) AMOUNT) instead",
    "add": "an effect such as (p) adds the fact",
    "del": "write (not (p)) instead",
    "delete": "write (not (p)) instead",
    "remove": "write (not (p)) instead",
    "~": "write not instead",
    "xor": "write (or (and A (not B)) (and (not A) B)) instead",
    "iff": "write (and (imply A B) (imply B A)) instead",
    "<=>": "write (and (imply A B) (imply B A)) instead",
    "<->": "write (and (imply A B) (imply B A)) instead",
    "neq": "write (not (= …)) instead",
    "not=": "write (not (= …)) instead",
    "not-equal": "write (not (= …)) instead",
    "≠": "write (not (= …)) instead",
    "eq": "write = instead",
    "equal": "write = instead",
    "equals": "write = instead",
    "gt": "write > instead",
    "lt": "write < instead",
    "ge": "write >= instead",
    "le": "write <= instead",
    "≥": "write >= instead",
    "≤": "write <= instead",
    "∧": "write and instead",
    "\u2228": "write or instead",
    "¬": "write not instead",
    "∀": "write forall instead",
    "∃": "write exists instead",
    "for-all": "write forall instead",
    "foreach": "write forall instead",
    "there-exists": "write exists instead",
}
"""Each operator with a hint."""

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

OF_FACTS = frozenset(["if", "set", "inc", "dec", "add", "del", "delete", "remove", "implies"])
"""Foreign words that have groups as operands; with objects they are undeclared predicates."""

_INFIX = frozenset(["=", "<", ">", "<=", ">=", "==", "!=", "<>", "+", "-", "*", "/", "+=", "-=",
                    "*=", ":=", "&&", "||", "and", "or"])  # fmt: skip


def is_comment(word: str) -> bool:
    """Return whether a comment of another language begins with a word.

    >>> is_comment("//"), is_comment("goal")
    (True, False)
    """
    return word.startswith(("//", "#", "/*"))


def is_infix(group: GroupNode) -> bool:
    """Whether a group has an operator between two operands, as in ``(f > 3)``.

    >>> word = [WordNode(text) for text in ("f", ">", "3")]
    >>> group = GroupNode(0)
    >>> group.extend(word)
    >>> is_infix(group)
    True
    """
    return len(group) == 3 and isinstance(group[1], WordNode) and group[1] in _INFIX
