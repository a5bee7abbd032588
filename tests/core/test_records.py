"""Records do what frozen dataclasses with slots do."""

import copy
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, asdict, dataclass, fields, is_dataclass, replace
from dataclasses import field as plain_field
from functools import cached_property
from typing import Any, TypeVar

import pytest

from hrcplan.core import records
from hrcplan.core.records import field, record

T = TypeVar("T")
Decorator = Callable[[type[T]], type[T]]


@record
class Box:
    """A record of a module, so that it can be pickled."""

    name: str
    sizes: tuple[int, ...] = ()
    notes: list[str] = field(default_factory=list, compare=False)
    hidden: int = field(default=0, repr=False)


@record
class TallBox(Box):
    """A record with the fields of another one."""

    height: int = 3

    def __str__(self) -> str:
        return f"{self.name} of {self.height}"


def place(decorate: Decorator[Any], field: Any) -> Any:
    """Return one class, made as a record or as a dataclass."""

    @decorate
    class Place:
        """A place."""

        name: str
        size: int = 1
        kinds: list[str] = field(default_factory=list, compare=False)
        index: int = field(default=7, repr=False)

        def __post_init__(self) -> None:
            if self.size < 0:
                raise ValueError("negative")

    return Place


RECORD = place(record, field)
PLAIN = place(dataclass(frozen=True, slots=True), plain_field)


@pytest.mark.parametrize("args", [("a",), ("a", 2), ("b", 1, ["x"]), ("b", 1, ["y"], 9)])
def test_it_prints_hashes_and_compares_as_a_dataclass(args: tuple[Any, ...]) -> None:
    mine, plain = RECORD(*args), PLAIN(*args)
    assert repr(mine) == repr(plain)
    assert hash(mine) == hash(plain)
    assert asdict(mine) == asdict(plain)
    for others in [("a",), ("a", 2), ("b", 1, []), ("b", 1, [], 9)]:
        assert (mine == RECORD(*others)) == (plain == PLAIN(*others))
    assert mine != plain
    assert RECORD.__match_args__ == PLAIN.__match_args__
    assert [part.name for part in fields(RECORD)] == [part.name for part in fields(PLAIN)]


@pytest.mark.parametrize("kind", [RECORD, PLAIN])
def test_it_cannot_change(kind: Any) -> None:
    box = kind("a")
    with pytest.raises(FrozenInstanceError, match="cannot assign to field 'size'"):
        box.size = 3
    with pytest.raises(FrozenInstanceError, match="cannot delete field 'size'"):
        del box.size
    assert replace(box, size=3).size == records.replace(RECORD("a"), size=3).size == 3
    with pytest.raises(ValueError, match="negative"):
        replace(box, size=-3)
    with pytest.raises(TypeError):
        kind()
    with pytest.raises(TypeError, match="__dict__"):
        vars(box)
    assert kind("a").kinds is not kind("a").kinds


@pytest.mark.parametrize("box", [Box("a", (1, 2), ["x"], 5), TallBox("b", height=9)])
def test_it_is_the_same_after_a_copy_and_a_pickle(box: Box) -> None:
    for again in (copy.copy(box), copy.deepcopy(box), pickle.loads(pickle.dumps(box))):
        assert again == box
        assert again.notes == box.notes
        assert type(again) is type(box)


def test_methods_of_the_class_and_of_a_base_stay() -> None:
    assert str(TallBox("b")) == "b of 3"
    assert repr(TallBox("b")) == "TallBox(name='b', sizes=(), notes=[], height=3)"
    assert TallBox("b") != Box("b")


@record
class Circle:
    """A record with a property that is computed once, compared by identity."""

    radius: int
    __eq__ = object.__eq__
    __hash__ = object.__hash__

    @cached_property
    def label(self) -> list[int]:
        return [self.radius]


def test_a_property_may_be_cached() -> None:
    circle = Circle(3)
    assert circle.label is circle.label
    assert records.replace(circle, radius=4).label == [4]
    assert pickle.loads(pickle.dumps(circle)).label == [3]
    assert circle != Circle(3)
    assert len({circle, Circle(3)}) == 2


def test_a_dataclass_may_derive_from_a_record() -> None:
    @dataclass(frozen=True)
    class Labelled(TallBox):
        label: str = "none"

    box = Labelled("b", label="x")
    assert is_dataclass(TallBox)
    assert (box.name, box.height, box.label) == ("b", 3, "x")
    assert [(f.name, f.type) for f in fields(TallBox)][-1] == ("height", int)


def test_names_of_the_methods_in_messages() -> None:
    with pytest.raises(TypeError, match=r"Box\.__init__\(\) missing 1 required"):
        Box()  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="the field"):
        place(record, plain_field)
