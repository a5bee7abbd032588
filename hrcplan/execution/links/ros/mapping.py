"""The mapping file: which ROS 2 action carries out a PDDL action, and which topics say what.

::

    [actions.move]                                # an action of the domain
    type = "nav2_msgs/action/NavigateToPose"
    name = "/{agent}/navigate_to_pose"            # {PARAMETER}: the object bound to it
    goal.pose.header.frame_id = "map"
    goal.pose.pose = "{places.to}"                # the entry of this object in a table
    done = { error_code = 0 }                     # else the result counts as failed
    limit_s = 120

    [tables.places]
    wp0 = { position = { x = 1.0, y = 2.0 }, orientation = { w = 1.0 } }

    [[topics]]
    name = "/robot/place"
    type = "std_msgs/msg/String"
    fact = "at robot {data}"                      # {FIELD}: what a field of the message holds

What a topic says: ``fact`` (with ``when = FIELD``, if a field says whether it holds), ``value``
(with ``from = FIELD``), ``said = FIELD``, ``begun = FIELD``, ``stop = FIELD``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hrcplan.core.files import read_bytes
from hrcplan.core.json_values import JsonValue
from hrcplan.core.text import nearest
from hrcplan.core.toml import line_of, read_toml
from hrcplan.errors import InputError

Keys = tuple[str | int, ...]
PLACEHOLDER = re.compile(r"\{([^{}]*)\}")
CODE = "bad-mapping"
RANGES = ("localhost", "subnet")
SAYS = ("fact", "value", "said", "begun", "stop")
_TYPE = re.compile(r"\w+/(\w+)/\w+")


@dataclass(frozen=True, slots=True)
class Near:
    """The object whose entry in a table is the nearest to a position, within a distance."""

    table: str
    field: str
    within: float


@dataclass(frozen=True, slots=True)
class ActionEntry:
    """How one PDDL action is carried out; templates are not yet filled in."""

    type: str
    name: str
    goal: Mapping[str, JsonValue]
    done: Mapping[str, JsonValue]
    limit_s: float | None


@dataclass(frozen=True, slots=True)
class TopicEntry:
    """What one topic says: ``says`` is one of `SAYS`, ``text`` its template or field."""

    name: str
    type: str
    says: str
    text: str
    field: str = ""
    agent: str = ""
    near: Near | None = None
    latched: bool = False

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields of a message that are looked at."""
        names = [name for name in PLACEHOLDER.findall(self.text) if name != "near"]
        if self.says not in ("fact", "value"):
            names.append(self.text)
        names += [self.field] if self.field else []
        return tuple(dict.fromkeys([*names, *([self.near.field] if self.near else [])]))


@dataclass(frozen=True)
class RosMapping:
    """A mapping file that has been read; ``domain_id`` and ``discovery`` are those of ROS 2."""

    path: Path
    actions: Mapping[str, ActionEntry] = field(default_factory=dict)
    topics: tuple[TopicEntry, ...] = ()
    tables: Mapping[str, Mapping[str, JsonValue]] = field(default_factory=dict)
    agents: tuple[str, ...] = ()
    domain_id: int | None = None
    discovery: str | None = None

    def fault(self, keys: Sequence[str | int], message: str, hint: str | None = None) -> InputError:
        """Return the error that says what is wrong with a value of the file, and where."""
        return fault(self.path, keys, message, hint)


def fault(
    path: Path, keys: Sequence[str | int], message: str, hint: str | None = None
) -> InputError:
    """Return the error that says what is wrong with a value of a mapping file, and where."""
    line = line_of(read_bytes(path).decode(errors="replace"), keys)
    where = ".".join(str(key) for key in keys if isinstance(key, str))
    text = f"{where}: {message}" if where else message
    return InputError(text, code=CODE, path=str(path), line=line, hint=hint)


def read_mapping(path: Path) -> RosMapping:
    """Return a mapping file; whether it fits a problem is not yet checked.

    Raises:
        InputError: if the file is missing or has a fault; it names the line.
    """
    table = _Table(path, (), read_toml(path, CODE))
    ros = table.table("ros")
    actions = table.table("actions")
    mapping = RosMapping(
        path,
        {name.lower(): _action(actions.table(name)) for name in actions.values},
        tuple(_topic(entry) for entry in table.tables("topics")),
        _object_tables(table.table("tables")),
        tuple(map(str.lower, ros.texts("agents"))),
        ros.number("domain_id", int),
        ros.choice("discovery", RANGES),
    )
    ros.end()
    table.end()
    return mapping


def _object_tables(tables: _Table) -> dict[str, dict[str, JsonValue]]:
    return {
        name: {key.lower(): value for key, value in tables.table(name).values.items()}
        for name in tables.values
    }


def _action(table: _Table) -> ActionEntry:
    entry = ActionEntry(
        table.interface("type", "action"), table.text("name"), table.table("goal").values,
        table.table("done").values, table.number("limit_s", float),
    )  # fmt: skip
    if entry.limit_s is not None and not 0 < entry.limit_s < float("inf"):
        raise table.fault("limit_s", "a number of seconds above 0 is needed")
    table.end()
    return entry


def _topic(table: _Table) -> TopicEntry:
    says = [key for key in SAYS if key in table.values]
    if len(says) != 1:
        message = f"a topic says one of {', '.join(SAYS)}"
        raise table.fault(None, message, 'for example: fact = "at robot {data}"')
    text = table.text(says[0])
    near = None
    if "near" in table.values:
        place = table.table("near")
        within = place.number("within", float)
        near = Near(place.text("table"), place.text("field"), 1.0 if within is None else within)
        place.end()
    if ("near" in PLACEHOLDER.findall(text)) != (near is not None):
        hint = '{near} in the fact, and near = {table = "places", field = "pose.position"}'
        raise table.fault(says[0], "{near} and 'near' belong together", hint)
    field_name = {"fact": "when", "value": "from"}.get(says[0])
    entry = TopicEntry(
        table.text("name"), table.interface("type", "msg"), says[0], text,
        table.text(field_name, "" if field_name == "when" else None) if field_name else "",
        table.text("agent", "").lower(), near, table.flag("latched"),
    )  # fmt: skip
    table.end()
    return entry


class _Table:
    """A table of the file; what is wrong with it is an error that names the line."""

    def __init__(self, path: Path, keys: Keys, values: Mapping[str, Any]) -> None:
        self.path, self.keys, self.values = path, keys, values
        self._seen: set[str] = set()

    def fault(self, key: str | None, message: str, hint: str | None = None) -> InputError:
        keys = self.keys if key is None else (*self.keys, key)
        return fault(self.path, keys, message, hint)

    def _value(self, key: str) -> Any:
        self._seen.add(key)
        return self.values.get(key)

    def table(self, key: str) -> _Table:
        value = self._value(key)
        if not isinstance(value, dict | None):
            raise self.fault(key, "a table is needed")
        return _Table(self.path, (*self.keys, key), value or {})

    def tables(self, key: str) -> Iterable[_Table]:
        value = self._value(key) or []
        if not isinstance(value, list) or not all(isinstance(one, dict) for one in value):
            raise self.fault(key, f"tables are needed: [[{key}]]")
        return [_Table(self.path, (*self.keys, key, n), one) for n, one in enumerate(value)]

    def text(self, key: str, default: str | None = None) -> str:
        value = self._value(key)
        if value is None and default is not None:
            return default
        if not isinstance(value, str) or not value.strip():
            raise self.fault(key if key in self.values else None, f"a text '{key}' is needed")
        return value

    def texts(self, key: str) -> list[str]:
        value = self._value(key) or []
        if not isinstance(value, list) or not all(isinstance(one, str) for one in value):
            raise self.fault(key, 'a list of texts is needed, as in ["robot"]')
        return value

    def interface(self, key: str, kind: str) -> str:
        value = self.text(key)
        match = _TYPE.fullmatch(value)
        if match is None or match[1] != kind:
            example = {"action": "nav2_msgs/action/NavigateToPose", "msg": "std_msgs/msg/String"}
            raise self.fault(key, f"'{value}' is no {kind} type", f'as in "{example[kind]}"')
        return value

    def number(self, key: str, kind: type) -> Any:
        value = self._value(key)
        fits = isinstance(value, int if kind is int else int | float) and value is not True
        if value is not None and not fits:
            raise self.fault(key, f"a {'whole ' if kind is int else ''}number is needed")
        return value

    def choice(self, key: str, choices: Sequence[str]) -> str | None:
        value = self._value(key)
        if value is not None and value not in choices:
            raise self.fault(key, f"one of {', '.join(choices)} is needed")
        return value  # type: ignore[no-any-return]

    def flag(self, key: str) -> bool:
        value = self._value(key)
        if not isinstance(value, bool | None):
            raise self.fault(key, "true or false is needed")
        return bool(value)

    def end(self) -> None:
        """Refuse keys that were not read."""
        for key in self.values:
            if key not in self._seen:
                hint = nearest(key, self._seen) or f"keys: {', '.join(sorted(self._seen))}"
                raise self.fault(key, "there is no such key", hint)
