"""Typed lists: ``a b - type c``, as in parameters, objects and type declarations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hrcplan.pddl.model import OBJECT, Param
from hrcplan.pddl.reader import Group, Node, Word
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.source import Source, nearest, quote

Entry = tuple[Word, tuple[str, ...], Sequence[Word]]
"""A name, the names of its types, and the words that spelled them (empty if untyped)."""


def read_typed(nodes: Sequence[Node], source: Source) -> Iterator[Entry]:
    """Yield every name of a typed list with its types (``object`` where none is given)."""
    waiting: list[Word] = []
    index = 0
    while index < len(nodes):
        node = nodes[index]
        if isinstance(node, Group):
            source.error(node.at, "not-a-name", "a name is expected here, not a group")
        elif node == "-":
            if not waiting:
                source.error(node.at, "bad-typed-list", "no name stands before this '-'")
            index += 1
            spelled = _type_words(nodes, index, node, source)
            for name in waiting:
                yield name, tuple(map(str, spelled)) or (OBJECT,), spelled
            waiting = []
        else:
            waiting.append(node)
        index += 1
    for name in waiting:
        yield name, (OBJECT,), ()


def _type_words(nodes: Sequence[Node], index: int, dash: Word, source: Source) -> list[Word]:
    if index >= len(nodes):
        source.error(dash.at, "bad-typed-list", "a type is missing after this '-'")
        return []
    node = nodes[index]
    if isinstance(node, Word):
        return [node]
    if node.head == "either" and len(node) > 1:
        return [word for word in node[1:] if isinstance(word, Word)]
    source.error(node.at, "bad-typed-list", "a type or (either …) is expected here")
    return []


def check_types(words: Sequence[Word], known: Sequence[str], source: Source) -> None:
    """Report every word that names no declared type."""
    for word in words:
        if word != OBJECT and word not in known:
            message = f"type {quote(word)} is not declared"
            source.error(word.at, "unknown-type", message, nearest(word, [*known, OBJECT]))


def read_params(node: Node, scope: Scope) -> tuple[Param, ...]:
    """Return the parameters in a group such as ``(?a - agent ?w)``."""
    if isinstance(node, Word):
        scope.source.error(node.at, "not-a-list", "a parameter list in parentheses is expected")
        return ()
    return params_of(node, scope.source, list(scope.domain.types))


def params_of(nodes: Sequence[Node], source: Source, types: Sequence[str]) -> tuple[Param, ...]:
    """Return parameters; a name without ``?``, repeated, or of an unknown type is an error."""
    found: dict[str, Param] = {}
    for name, kinds, words in read_typed(nodes, source):
        if not name.startswith("?") or len(name) == 1:
            source.error(name.at, "not-a-variable", f"{quote(name)} should start with '?'")
        elif name in found:
            message = f"parameter {quote(name)} is repeated"
            source.error(name.at, "repeated-parameter", message)
        else:
            found[str(name)] = Param(str(name), kinds)
        check_types(words, types, source)
    return tuple(found.values())
