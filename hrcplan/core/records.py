"""Immutable classes with named fields, like ``dataclass(frozen=True, slots=True)``, but faster.

`dataclasses` compiles six methods for each class, and its import reads the modules that look at
source code: together a third of a short command. Here ``__init__`` is compiled with the class and
fills the slots directly, so that an instance is made in half the time, too; ``__eq__`` and
``__hash__`` are compiled when they are first called.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar, dataclass_transform

T = TypeVar("T")


class FieldSpec:
    """What is special about a field."""

    def __init__(self, *, repr: bool = True, compare: bool = True, **defaults: Hashable) -> None:
        self.repr = repr
        self.compare = compare
        self.defaults: Mapping[str, Any] = defaults


def _replace(record: T, /, **changes: Hashable) -> T:
    """Return a copy of a record with other values of some fields."""
    cls: Callable[..., T] = type(record)
    values = {name: getattr(record, name) for name in _fields_of(type(record))}
    return cls(**{**values, **changes})


if TYPE_CHECKING:
    from dataclasses import field as field
    from dataclasses import replace as replace
else:
    field, replace = FieldSpec, _replace

_DATACLASS_NAMES = ("__dataclass_fields__", "__dataclass_params__")
_MISSING = object()


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def record(cls: type[T]) -> type[T]:
    """Return a class as a dataclass that is frozen and has slots.

    ``dataclasses.fields``, ``replace`` and ``asdict``, and a ``__post_init__``, work as usual;
    `field` and `replace` of this module do so without the import of `dataclasses`. All fields are
    arguments of ``__init__``, by position or by name. Properties may be cached.

    >>> @record
    ... class Place:
    ...     name: str
    ...     size: int = 1
    >>> Place("hall"), Place("hall") == Place("hall", 2)
    (Place(name='hall', size=1), False)
    """
    own = vars(cls)
    kinds = {k: v for k, v in _annotations(cls).items() if "ClassVar" not in str(v)}
    specs = {name: _spec(own, name) for name in kinds}
    before = {k: v for base in reversed(cls.__mro__[1:]) for k, v in _fields_of(base).items()}
    slots = [name for name in kinds if name not in before]
    if any(isinstance(value, cached_property) for value in own.values()):
        slots.append("__dict__")
    apart = {*kinds, "__dict__", "__weakref__"}
    members = {name: value for name, value in own.items() if name not in apart}
    members |= {"__slots__": tuple(slots), "__record_fields__": {**before, **specs}}
    members["__match_args__"] = tuple(members["__record_fields__"])
    new = _metaclass(cls)(cls.__name__, cls.__bases__, {**_SHARED, **members})
    new.__qualname__ = cls.__qualname__
    _add_methods(new, own)
    return new


def _metaclass(cls: type[T]) -> Callable[..., type[T]]:
    return type(cls)


def _spec(own: Mapping[str, Any], name: str) -> FieldSpec:
    if name not in own:
        return FieldSpec()
    value = own[name]
    if type(value).__name__ == "Field":
        raise TypeError(f"{name}: the field() of a record is that of {__name__}")
    return value if isinstance(value, FieldSpec) else FieldSpec(default=value)


def _annotations(cls: type) -> Mapping[str, Any]:
    kinds: Mapping[str, Any] = vars(cls).get("__annotations__", {})
    return kinds


def _fields_of(cls: type) -> Mapping[str, FieldSpec]:
    specs: Mapping[str, FieldSpec] = vars(cls).get("__record_fields__", {})
    return specs


def _add_methods(cls: type, own: Mapping[str, object]) -> None:
    """Add the methods that are called often, of one text each, unless the class has its own."""
    for name in _TEXTS:
        if name not in own:
            setattr(cls, name, (_compiled if name == "__init__" else _later)(cls, name))
    for name in _DATACLASS_NAMES:
        setattr(cls, name, _DataclassView(name))


def _later(cls: type, name: str) -> Callable[..., Any]:
    """Return a method that compiles the one that takes its place, and calls that."""

    def method(*args: Hashable) -> Any:
        setattr(cls, name, _compiled(cls, name))
        return getattr(cls, name)(*args)

    return method


def _compiled(cls: type, name: str) -> Any:
    words: dict[str, Any] = {"MISSING": _MISSING}
    exec(_TEXTS[name](cls, words), words)
    words[name].__qualname__ = f"{cls.__qualname__}.{name}"
    return words[name]


def _init_text(cls: type, words: dict[str, Any]) -> str:
    head, body = ["self"], list[str]()
    for name, spec in _fields_of(cls).items():
        value = name
        words[f"set_{name}"] = getattr(cls, name).__set__
        if "default" in spec.defaults:
            words[f"default_{name}"] = spec.defaults["default"]
            head.append(f"{name}=default_{name}")
        elif "default_factory" in spec.defaults:
            words[f"make_{name}"] = spec.defaults["default_factory"]
            head.append(f"{name}=MISSING")
            value = f"make_{name}() if {name} is MISSING else {name}"
        else:
            head.append(name)
        body.append(f"set_{name}(self, {value})")
    if "__post_init__" in dir(cls):
        body.append("self.__post_init__()")
    return f"def __init__({', '.join(head)}): {'; '.join(body) or 'pass'}"


def _eq_text(cls: type, _: Mapping[str, object]) -> str:
    mine, others = _values(cls, "self"), _values(cls, "other")
    test = f"({mine}) == ({others}) if other.__class__ is self.__class__ else NotImplemented"
    return f"def __eq__(self, other): return {test}"


def _hash_text(cls: type, _: Mapping[str, object]) -> str:
    return f"def __hash__(self): return hash(({_values(cls, 'self')}))"


def _values(cls: type, owner: str) -> str:
    return "".join(f"{owner}.{n}," for n, spec in _fields_of(cls).items() if spec.compare)


_TEXTS = {"__init__": _init_text, "__eq__": _eq_text, "__hash__": _hash_text}


class _DataclassView:
    """What `dataclasses` wants to know about a class, made when it asks."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, instance: Hashable, cls: type) -> object:
        import dataclasses

        owner = next(base for base in cls.__mro__ if vars(base).get(self._name) is self)
        kinds = {k: v for base in owner.__mro__ for k, v in _annotations(base).items()}
        parts = [
            (name, kinds[name], dataclasses.field(repr=s.repr, compare=s.compare, **s.defaults))
            for name, s in _fields_of(owner).items()
        ]
        twin = dataclasses.make_dataclass(owner.__name__, parts, frozen=True, eq=False)
        for name in _DATACLASS_NAMES:
            setattr(owner, name, getattr(twin, name))
        return getattr(owner, self._name)


class _Record:
    """The methods that all records share."""

    __record_fields__: Mapping[str, FieldSpec]

    def __repr__(self) -> str:
        parts = (name for name, spec in self.__record_fields__.items() if spec.repr)
        pairs = [f"{name}={getattr(self, name)!r}" for name in parts]
        return f"{type(self).__qualname__}({', '.join(pairs)})"

    def __setattr__(self, name: str, value: Hashable) -> NoReturn:
        from dataclasses import FrozenInstanceError

        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> NoReturn:
        from dataclasses import FrozenInstanceError

        raise FrozenInstanceError(f"cannot delete field {name!r}")

    def __getstate__(self) -> list[Any]:
        return [getattr(self, name) for name in self.__record_fields__]

    def __setstate__(self, state: Sequence[Any]) -> None:
        for name, value in zip(self.__record_fields__, state, strict=True):
            object.__setattr__(self, name, value)


_SHARED: dict[str, Any] = {
    name: vars(_Record)[name]
    for name in ("__repr__", "__setattr__", "__delattr__", "__getstate__", "__setstate__")
}
