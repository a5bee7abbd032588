"""Rows of names: the objects that parameters are bound to, and what makes facts from them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import itemgetter

Row = tuple[str, ...]
RowKey = Callable[[Row], Row]
"""What makes a fact, the key of a function, or another row from a row."""


def picker(places: Sequence[int]) -> RowKey:
    """Return what makes a row of the values at some places of another.

    >>> picker([2])(("at", "ann", "hall")), picker([])(("at", "ann"))
    (('hall',), ())
    """
    if not places:
        return lambda row: ()
    if len(places) == 1:
        place = places[0]
        return lambda row: (row[place],)
    return itemgetter(*places)


class LiteralRows:
    """The rows of a schema, the objects of its parameters first, and what makes facts from them.

    >>> rows = LiteralRows(["?a", "?b"])
    >>> fact = rows.key("at", ["?b", "home"])
    >>> fact(rows.of(("ann", "box")))
    ('at', 'box', 'home')
    """

    def __init__(self, params: Sequence[str]) -> None:
        self._places = {name: place for place, name in enumerate(params)}
        self._names: list[str] = []
        self._n_params = len(params)

    def key(self, name: str, args: Sequence[str]) -> RowKey:
        """Return what makes the key ``(name, *args)`` from a row, with variables replaced."""
        places = [self._place(name, is_variable=False)]
        return picker([*places, *(self._place(arg, is_variable=True) for arg in args)])

    def _place(self, name: str, is_variable: bool) -> int:
        if is_variable and name in self._places:
            return self._places[name]
        if name not in self._names:
            self._names.append(name)
        return self._n_params + self._names.index(name)

    def of(self, args: Row) -> Row:
        """Return the row of an instance: its objects, and the names that the keys need."""
        return (*args, *self._names)
