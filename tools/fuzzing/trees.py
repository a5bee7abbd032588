"""Changes of PDDL files that keep names and shapes: mutants that most checks let through.

A domain and its problem are changed together, as groups of words. A name gets another one wherever
it stands; conditions, effects and facts are moved, exchanged, repeated, left out and negated.
"""

from __future__ import annotations

import copy
import random
import re
from collections.abc import Callable, Iterator

Tree = list["Tree | str"]

TOKEN = re.compile(r";[^\n]*|[()]|[^\s();]+")
NAME = re.compile(r"[a-z][\w-]*$")
NUMBER = re.compile(r"-?[\d.]+$")
NUMBERS = ("0", "1", "2", "3", "7", "0.5", "0.1", "-1", "100", "1e-7", "0.3333333", "1000000007")
NEW_NAMES = ("another", "at", "over", "when", "start", "end", "all", "define", "problem", "object")
KEYWORDS = frozenset([
    "define", "domain", "problem", "and", "or", "not", "imply", "forall", "exists", "when", "at",
    "over", "start", "end", "all", "increase", "decrease", "assign", "scale-up", "scale-down",
    "minimize", "maximize", "object", "number", "either", "preference", "total-cost", "total-time",
    "is-violated", "always", "sometime", "within", "at-most-once", "sometime-after",
])  # fmt: skip
FORMULAS = (":precondition", ":condition", ":goal", ":effect")
DEFINITIONS = (":action", ":durative-action", ":derived", "define")


def parse(text: str) -> Tree:
    """Return the groups of a text whose parentheses match, in lower case, without comments."""
    stack: list[Tree] = [[]]
    for token in TOKEN.findall(text.lower()):
        if token == "(":
            stack.append([])
        elif token == ")":
            stack[-2].append(stack.pop())
        elif not token.startswith(";"):
            stack[-1].append(token)
    return stack[0]


def text(tree: Tree) -> str:
    """Return the groups as a text, one line per group of the file's outer groups."""
    return "\n".join(_text(node, 0) for node in tree)


def _text(node: Tree | str, depth: int) -> str:
    if isinstance(node, str):
        return node
    between = "\n " if depth < 2 else " "
    return "(" + between.join(_text(child, depth + 1) for child in node) + ")"


def mutant(rng: random.Random, sources: list[str]) -> list[str]:
    """Return a domain and a problem after a few changes."""
    trees = [parse(source) for source in sources]
    for _ in range(rng.choice((1, 1, 2, 3, 5))):
        rng.choice(CHANGES)(rng, trees)
    return [text(tree) for tree in trees]


def groups(tree: Tree) -> Iterator[Tree]:
    """Yield all groups below a group."""
    for child in tree:
        if isinstance(child, list):
            yield child
            yield from groups(child)


def _any_group(rng: random.Random, trees: list[Tree]) -> Tree:
    """Return a group of the domain or of the problem that is inside of ``define``."""
    return rng.choice([g for g in groups(rng.choice(trees)) if _head(g) != "define"] or trees)


def _head(group: Tree) -> str:
    return group[0] if group and isinstance(group[0], str) else ""


def _replace_words(tree: Tree, words: dict[str, str]) -> None:
    for group in (tree, *groups(tree)):
        group[:] = [words.get(c, c) if isinstance(c, str) else c for c in group]


def _words(tree: Tree) -> list[str]:
    return sorted({word for group in groups(tree) for word in group if isinstance(word, str)})


def rename(rng: random.Random, trees: list[Tree]) -> None:
    """Give a name another one wherever it stands; now and then one that is there already."""
    names = [w for t in trees for w in _words(t) if NAME.match(w) and w not in KEYWORDS]
    if names:
        new = rng.choice(names) if rng.random() < 0.3 else rng.choice(NEW_NAMES)
        for tree in trees:
            _replace_words(tree, {rng.choice(names): new})


def exchange_names(rng: random.Random, trees: list[Tree]) -> None:
    """Let two names change places wherever they stand: nothing but an order is another."""
    names = [w for t in trees for w in _words(t) if NAME.match(w) and w not in KEYWORDS]
    if names:
        one, other = rng.choice(names), rng.choice(names)
        for tree in trees:
            _replace_words(tree, {one: other, other: one})


def join_variables(rng: random.Random, trees: list[Tree]) -> None:
    """Use one variable of an action for another in some of its groups."""
    actions = [g for g in groups(trees[0]) if _head(g) in DEFINITIONS[:3]]
    if actions:
        action = rng.choice(actions)
        variables = [word for word in _words(action) if word.startswith("?")]
        parts = [g for g in groups(action) if not _head(g).startswith("?")]
        if variables and parts:
            _replace_words(rng.choice(parts), {rng.choice(variables): rng.choice(variables)})


def exchange(rng: random.Random, trees: list[Tree]) -> None:
    """Exchange two entries of a group."""
    group = _any_group(rng, trees)
    if len(group) > 2:
        i, j = rng.randrange(1, len(group)), rng.randrange(1, len(group))
        group[i], group[j] = group[j], group[i]


def repeat(rng: random.Random, trees: list[Tree]) -> None:
    """Write a group twice."""
    parent = _parent(rng, trees)
    at = _place(rng, parent)
    if at is not None:
        parent.insert(rng.randrange(1, len(parent) + 1), copy.deepcopy(parent[at]))


def leave_out(rng: random.Random, trees: list[Tree]) -> None:
    """Leave a group out of its list."""
    parent = _parent(rng, trees)
    at = _place(rng, parent)
    if at is not None:
        del parent[at]


def _parent(rng: random.Random, trees: list[Tree]) -> Tree:
    """Return a group that holds a list of groups, such as ``and`` or ``:init``."""
    wide = [g for t in trees for g in groups(t) if sum(isinstance(c, list) for c in g) > 1]
    return rng.choice([g for g in wide if _head(g) not in DEFINITIONS] or wide or trees)


def _place(rng: random.Random, parent: Tree) -> int | None:
    places = [i for i, child in enumerate(parent) if isinstance(child, list)]
    return rng.choice(places) if places else None


def move(rng: random.Random, trees: list[Tree]) -> None:
    """Write a group also, or instead, into another list of the same kind."""
    tree = rng.choice(trees)
    source = _parent(rng, [tree])
    at = _place(rng, source)
    targets = [g for g in groups(tree) if _head(g) == _head(source) and g is not source]
    if at is not None and targets:
        rng.choice(targets).append(copy.deepcopy(source[at]))
        if rng.random() < 0.5:
            del source[at]


def another_number(rng: random.Random, trees: list[Tree]) -> None:
    """Write another number for one."""
    places = [
        (group, i)
        for tree in trees
        for group in groups(tree)
        for i, word in enumerate(group)
        if isinstance(word, str) and NUMBER.match(word)
    ]
    if places:
        group, i = rng.choice(places)
        group[i] = rng.choice(NUMBERS)


def another_word(rng: random.Random, trees: list[Tree]) -> None:
    """Write another name or variable of the same group of the file for one."""
    group = _any_group(rng, trees)
    places = [i for i, word in enumerate(group[1:], 1) if isinstance(word, str)]
    if places:
        at = rng.choice(places)
        old = str(group[at])
        alike = [g for t in trees for g in groups(t) if _head(g) == _head(group)]
        words = [w for g in alike for w in g[1:] if isinstance(w, str) and w[0] == old[0]]
        group[at] = rng.choice(words or [old])


def wrap(rng: random.Random, trees: list[Tree]) -> None:
    """Put a condition or effect into a negation, disjunction, quantifier or ``when``."""
    places = [
        (group, i)
        for tree in trees
        for group in groups(tree)
        for i in range(1, len(group))
        if isinstance(group[i], list)
        if group[i - 1] in FORMULAS or _head(group) in ("and", "or")
    ]
    if places:
        group, i = rng.choice(places)
        other = copy.deepcopy(rng.choice([g[j] for g, j in places]))
        group[i] = rng.choice(_forms(group[i], other))


def _forms(old: Tree | str, other: Tree | str) -> list[Tree]:
    """Return formulas that hold one formula, some of them another one too."""
    fresh: Tree = ["?fresh", "-", "object"]
    opposite: Tree = ["not", copy.deepcopy(old)]
    return [
        ["not", old], ["and", old], ["or", old, other], ["imply", other, old],
        ["when", other, old], ["when", ["and"], old], ["not", ["not", old]],
        ["forall", fresh, old], ["exists", fresh, old], ["and", old, opposite],
        ["or", old, opposite], ["forall", ["?fresh"], ["or", old, ["=", "?fresh", "?fresh"]]],
    ]  # fmt: skip


def other_time(rng: random.Random, trees: list[Tree]) -> None:
    """Let something that is at the start be at the end, or all the time."""
    times = [g for g in groups(trees[0]) if len(g) == 3 and g[0] in ("at", "over")]
    times = [g for g in times if g[1] in ("start", "end", "all")]
    if times:
        rng.choice(times)[:2] = rng.choice((["at", "start"], ["at", "end"], ["over", "all"]))


def other_sense(rng: random.Random, trees: list[Tree]) -> None:
    """Write another operator or sense of the metric for one."""
    kinds = (
        ("minimize", "maximize"), ("increase", "decrease", "assign", "scale-up", "scale-down"),
        ("<", ">", "<=", ">=", "="), ("and", "or"), ("+", "-", "*", "/"), ("forall", "exists"),
    )  # fmt: skip
    kind = rng.choice(kinds)
    alike = [g for tree in trees for g in groups(tree) if _head(g) in kind]
    if alike:
        rng.choice(alike)[0] = rng.choice(kind)


Change = Callable[[random.Random, list[Tree]], None]
CHANGES: tuple[Change, ...] = (
    rename, exchange_names, join_variables, exchange, repeat, leave_out, move, another_number,
    another_word, wrap, other_time, other_sense,
)  # fmt: skip
