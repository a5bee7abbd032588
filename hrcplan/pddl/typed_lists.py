"""Typed lists: ``a b - type c``, as in parameters, objects and type declarations."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import count, pairwise

from hrcplan.core.text import quote
from hrcplan.pddl.model import OBJECT, Param
from hrcplan.pddl.reader import FlatNode, GroupNode, ParseNode, WordNode
from hrcplan.pddl.scope import Scope
from hrcplan.pddl.source import SourceText

NO_PRIVATE = "(:private …) of MA-PDDL is not supported"

Entry = tuple[WordNode, tuple[str, ...]]
"""A name and the names of its types."""


def read_typed(
    nodes: Sequence[ParseNode], source: SourceText, types: Collection[str] | None = None
) -> Iterator[Entry]:
    """Yield every name of a typed list with its types (``object`` where none is given).

    A type that is not among ``types`` is an error, unless ``types`` is None.
    """
    waiting: list[WordNode] = []
    if any(isinstance(node, GroupNode) or node == ":" for node in nodes):
        nodes = list(_flat(nodes, source))
    rest = iter(with_dashes(nodes, source, types))
    for node in rest:
        if isinstance(node, GroupNode):
            hint = "leave its parentheses out"
            source.error(node.at, "not-a-name", "a name is expected here, not a group", hint)
        elif node[0] in ":\"'" and types is not None:
            _report_odd_name(node, source)
            waiting += [_part(node, 1, len(node.rstrip("\"'")))]
        elif node != "-":
            waiting.append(node)
        else:
            words = _type_words(_after_dashes(rest, source), node, source)
            if words and not waiting:
                message = "no name stands before this '-', so it declares nothing"
                hint = "names stand before it, their type behind it: 'NAME - type'"
                source.warn(node.at, "empty-typed-list", message, hint)
            if types is not None:
                check_types(words, types, source)
            source.use(":typing", node.at)
            for name in waiting:
                yield name, tuple(map(str, words)) or (OBJECT,)
            waiting = []
    for name in waiting:
        _warn_of_joined(name, types or (), source)
        yield name, (OBJECT,)


def _warn_of_joined(name: WordNode, types: Collection[str], source: SourceText) -> None:
    """Warn about ``?c-crane`` without a type, if ``crane`` is one."""
    start, dash, kind = name.rpartition("-")
    if dash and kind in types and len(start) > name.startswith("?"):
        message = f"{quote(name)} is one name, of no type"
        source.warn(name.at, "missing-space", message, f"write '{start} - {kind}' if that is meant")


def _flat(nodes: Sequence[ParseNode], source: SourceText) -> Iterator[ParseNode]:
    """Yield the nodes of a list; groups of names in it are one error, and read all the same."""
    is_first = True
    for before, node in pairwise((None, *nodes)):
        if node == ":":
            message, hint = "':' cannot stand in a list", "a '-' stands before a type"
            source.error(node.at, "bad-typed-list", message, hint)
            dash = WordNode("-")
            dash.at = node.at
            yield dash
            continue
        if not isinstance(node, GroupNode) or before == "-" or node.head in ("", "either"):
            assert node is not None
            yield node
            continue
        if node.head == ":private":
            source.error(node.at, "unsupported", NO_PRIVATE, "list its names with the others")
            yield from node[1:]
            continue
        if is_first:
            message, hint = "a name is expected here, not a group", "leave its parentheses out"
            source.error(node.at, "not-a-name", message, hint)
        is_first = False
        yield from node


def _no_variable(name: WordNode, types: Collection[str]) -> tuple[str, str]:
    """Return message and hint for a word where a variable is expected."""
    if name == "?":
        return "a variable needs a name behind its '?'", "write the name without a space: ?name"
    hint = f"the type stands behind: ?x - {name}" if name in types else f"write ?{name}"
    if name in ("in", "of", "is", "as", "isa"):
        hint = "a '-' stands before a type"
    return f"{quote(name)} should start with '?'", hint


def _report_odd_name(word: WordNode, source: SourceText) -> None:
    if word[0] == ":":
        message, hint = f"{quote(word)} is no name", "a type stands behind ' - ', as in 'a - type'"
    else:
        message, hint = f"a name has no quotation marks: {quote(word)}", "remove them"
    source.error(word.at, "not-a-name", message, hint)


def with_dashes(
    nodes: Sequence[ParseNode], source: SourceText, types: Collection[str] | None = None
) -> Iterator[ParseNode]:
    """Yield the nodes with every dash as a word of its own, also one that touches a name."""
    for node, following in pairwise((*nodes, None)):
        assert node is not None
        if isinstance(node, GroupNode) or node == "-" or "-" not in (node[0], node[-1]):
            yield node
        elif node == "--":
            yield from (_part(node, 0, 1), _part(node, 1, 2))
        elif node[0] == "-":
            message, hint = f"a space is missing after the '-' of {quote(node)}", "write '- type'"
            source.warn(node.at, "missing-space", message, hint)
            yield _part(node, 0, 1)
            yield _part(node, 1, len(node))
        elif following in (types or ()) or following == OBJECT:
            message = f"a space is missing before the '-' of {quote(node)}"
            source.error(node.at, "missing-space", message, f"write '{node[:-1]} - {following}'")
            yield _part(node, 0, len(node) - 1)
            yield _part(node, len(node) - 1, len(node))
        else:
            yield node


def _part(word: WordNode, first: int, end: int) -> WordNode:
    part = WordNode(word[first:end])
    part.at = word.at + first
    return part


def _after_dashes(rest: Iterator[ParseNode], source: SourceText) -> ParseNode | None:
    """Return what follows a dash; a second dash is an error, and read over."""
    for node in rest:
        if node != "-":
            return node
        source.error(node.at, "bad-typed-list", "one '-' is enough", "write 'NAME - type'")
    return None


def _type_words(node: ParseNode | None, dash: WordNode, source: SourceText) -> list[WordNode]:
    if node is None:
        message, hint = "a type is missing after this '-'", "write '- type', or remove the '-'"
        source.error(dash.at, "bad-typed-list", message, hint)
        return []
    if isinstance(node, WordNode):
        return [node]
    words = [word for word in node[1:] if isinstance(word, WordNode)]
    if node.head == "either" and words and len(words) == len(node) - 1:
        return words
    hint = "write '- type' or '- (either type type)'"
    source.error(node.at, "bad-typed-list", "a type or (either …) is expected here", hint)
    return []


def check_types(words: Sequence[WordNode], types: Collection[str], source: SourceText) -> None:
    """Remember every word that names no declared type, for ``report_types``."""
    for word in words:
        if word != OBJECT and word not in types:
            source.unknown_types.setdefault(str(word), word.at)


def report_types(source: SourceText, types: Collection[str]) -> None:
    """Report the types that a file names without a declaration; if there are none, in one go."""
    names = {n: at for n, at in source.unknown_types.items() if n not in source.reported_types}
    if not types and names:
        message = "types are named, but the domain declares none"
        cure = f"add (:types {' '.join(names)}) to the domain"
        source.error(min(names.values()), "unknown-type", message, cure)
        return
    for name, at in names.items():
        message = f"type {quote(name)} is not declared"
        joined = (f"{name}-{above}" for above in (OBJECT, *types))
        whole = next((word for word in joined if word in types), "")
        hint = f"the name {quote(whole)} has no spaces around its '-'" if whole else None
        otherwise = "declare it in (:types …)"
        source.unknown(at, "unknown-type", message, name, [*types, OBJECT], hint, otherwise)


def read_params(node: ParseNode, scope: Scope) -> tuple[Param, ...]:
    """Return the parameters in a group such as ``(?a - agent ?w)``."""
    if isinstance(node, WordNode):
        hint = f"write ({node})"
        message = "a parameter list in parentheses is expected"
        scope.source.error(node.at, "not-a-list", message, hint)
        return params_of([node], scope.source, scope.domain.types) if node[0] == "?" else ()
    if isinstance(node, FlatNode):
        params = plain_params(node.words(), scope.source, scope.domain.types)
        if params is not None:
            return params
    return params_of(node, scope.source, scope.domain.types)


def plain_params(
    words: Sequence[str], source: SourceText, types: Collection[str]
) -> tuple[Param, ...] | None:
    """Return the parameters that words declare; None if anything about them needs a second look."""
    params: list[Param] = []
    names: list[str] = []
    rest = iter(words)
    for word in rest:
        if word[0] == "?" and word[-1] not in "?-":
            names.append(word)
            continue
        kind = next(rest, "-")
        if word != "-" or kind[0] == "-" or kind[-1] == "-" or len(params) == len(names):
            return None
        if (kind not in types and kind != OBJECT) or ":typing" not in source.uses:
            return None
        kinds = (kind,)
        params += [Param(name, kinds) for name in names[len(params) :]]
    untyped = names[len(params) :]
    if any(name.rpartition("-")[2] in types for name in untyped):
        return None
    params += map(Param, untyped)
    return tuple(params) if len(set(names)) == len(names) else None


def params_of(
    nodes: Sequence[ParseNode],
    source: SourceText,
    types: Collection[str],
    declaration: bool = False,
) -> tuple[Param, ...]:
    """Return parameters; a name without ``?``, repeated, or of an unknown type is an error.

    In a declaration of a predicate or function names mean nothing, and a repeated one is a
    warning. A faulty parameter keeps its place, so that arguments are still counted right.
    """
    params: list[Param] = []
    names: set[str] = set()
    numbers: dict[str, Iterator[int]] = {}
    wrong = 0
    for name, kinds in read_typed(nodes, source, types):
        text = str(name)
        if not name.startswith("?") or len(name) == 1:
            wrong += 1
            if wrong == 1:
                source.error(name.at, "not-a-variable", *_no_variable(name, types))
        elif name in names and declaration:
            message, hint = f"parameter {quote(name)} is repeated", "give each its own name"
            source.warn(name.at, "repeated-parameter", message, hint)
            own = numbers.setdefault(text, count(2))
            text = next(n for i in own if (n := f"{name}-{i}") not in names)
        elif name in names:
            message = f"parameter {quote(name)} is repeated"
            source.error(name.at, "repeated-parameter", message, "give each its own name")
        names.add(text)
        params.append(Param(f"?{text.lstrip('?')}", kinds))
    if wrong:  # what is untyped in a faulty list may be of any type
        return tuple(Param(p.name, ("?",) if p.types == (OBJECT,) else p.types) for p in params)
    return tuple(params)
