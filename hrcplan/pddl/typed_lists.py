"""Typed lists: ``a b - type c``, as in parameters, objects and type declarations."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from hrcplan.core.text import quote
from hrcplan.pddl.model import OBJECT, Param
from hrcplan.pddl.reader import GroupNode, ParseNode, WordNode
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.source import SourceText

Entry = tuple[WordNode, tuple[str, ...]]
"""A name and the names of its types."""


def read_typed(
    nodes: Sequence[ParseNode], source: SourceText, types: Collection[str] | None = None
) -> Iterator[Entry]:
    """Yield every name of a typed list with its types (``object`` where none is given).

    A type that is not among ``types`` is an error, unless ``types`` is None.
    """
    waiting: list[WordNode] = []
    rest = iter(nodes)
    for node in rest:
        if isinstance(node, GroupNode):
            source.error(node.at, "not-a-name", "a name is expected here, not a group")
        elif node != "-":
            waiting.append(node)
        else:
            if not waiting:
                source.error(node.at, "bad-typed-list", "no name stands before this '-'")
            spelled = _type_words(next(rest, None), node, source)
            if types is not None:
                check_types(spelled, types, source)
            source.use(":typing", node.at)
            for name in waiting:
                yield name, tuple(map(str, spelled)) or (OBJECT,)
            waiting = []
    for name in waiting:
        yield name, (OBJECT,)


def _type_words(node: ParseNode | None, dash: WordNode, source: SourceText) -> list[WordNode]:
    if node is None or node == "-":
        source.error(dash.at, "bad-typed-list", "a type is missing after this '-'")
        return []
    if isinstance(node, WordNode):
        return [node]
    words = [word for word in node[1:] if isinstance(word, WordNode)]
    if node.head == "either" and words and len(words) == len(node) - 1:
        return words
    source.error(node.at, "bad-typed-list", "a type or (either …) is expected here")
    return []


def check_types(words: Sequence[WordNode], known: Collection[str], source: SourceText) -> None:
    """Report every word that names no declared type."""
    for word in words:
        if word != OBJECT and word not in known:
            message = f"type {quote(word)} is not declared"
            source.unknown(word.at, "unknown-type", message, word, [*known, OBJECT])


def read_params(node: ParseNode, scope: Scope) -> tuple[Param, ...]:
    """Return the parameters in a group such as ``(?a - agent ?w)``."""
    if isinstance(node, WordNode):
        scope.source.error(node.at, "not-a-list", "a parameter list in parentheses is expected")
        return ()
    return params_of(node, scope.source, scope.domain.types)


def params_of(
    nodes: Sequence[ParseNode], source: SourceText, types: Collection[str]
) -> tuple[Param, ...]:
    """Return parameters; a name without ``?``, repeated, or of an unknown type is an error.

    A faulty parameter keeps its place, so that arguments are still counted right.
    """
    found: list[Param] = []
    seen: set[str] = set()
    for name, kinds in read_typed(nodes, source, types):
        if not name.startswith("?") or len(name) == 1:
            source.error(name.at, "not-a-variable", f"{quote(name)} should start with '?'")
        elif name in seen:
            message = f"parameter {quote(name)} is repeated"
            source.error(name.at, "repeated-parameter", message)
        seen.add(name)
        found.append(Param(f"?{name.lstrip('?')}", kinds))
    return tuple(found)
