"""A mapping and a problem: goals for actions, and what messages of topics mean."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from hrcplan.core.json_values import JsonValue
from hrcplan.core.text import nearest
from hrcplan.errors import UsageError
from hrcplan.execution.links import messages as msg
from hrcplan.execution.links.ros.mapping import PLACEHOLDER, ActionEntry, RosMapping, TopicEntry
from hrcplan.pddl.conventions import robots
from hrcplan.pddl.model import Action, Fact, Problem
from hrcplan.pddl.settings import check_function

ParameterObjects = Mapping[str, str]
"""Objects by the names of parameters, without question marks."""


class FilledMapping:
    """A mapping that fits a problem.

    Attributes:
        mapping: The file.
        agents: The robots whose actions it carries out.

    Args:
        mapping: The file.
        problem: The problem.
        are_actions_known: Whether actions need no entry.

    Raises:
        InputError: naming the line of what does not fit.
    """

    def __init__(
        self, mapping: RosMapping, problem: Problem, are_actions_known: bool = False
    ) -> None:
        self.mapping, self.problem = mapping, problem
        self.agents = mapping.agents or tuple(sorted(robots(problem)))
        for agent in mapping.agents:
            if agent not in robots(problem):
                hint = f"robots: {', '.join(sorted(robots(problem)))}"
                raise mapping.fault(("ros", "agents"), f"'{agent}' takes no commands here", hint)
        if not are_actions_known:
            self._check_actions()
        for n, topic in enumerate(mapping.topics):
            self._check_topic(n, topic)

    # Actions.

    def _check_actions(self) -> None:
        schemas = self.problem.domain.schemas
        for name, entry in self.mapping.actions.items():
            if name not in schemas:
                hint = nearest(name, schemas) or f"actions: {', '.join(schemas)}"
                message = "the domain has no such action"
                raise self.mapping.fault(("actions", name), message, hint)
            self._check_templates(schemas[name], entry)
        for schema in schemas.values():
            if schema.name not in self.mapping.actions and self.is_served(schema):
                hint = f"add a table [actions.{schema.name}] with type, name and goal"
                message = f"there is no entry for '{schema.name}', which a robot can do"
                raise self.mapping.fault(("actions",), message, hint)

    def is_served(self, schema: Action) -> bool:
        """Whether a robot of the mapping can be the agent of an action."""
        for param in schema.params:
            objects = self.problem.objects_of(param.types)
            if any(agent in objects for agent in self.problem.agents):
                return any(agent in objects for agent in self.agents)
        return False

    def _check_templates(self, schema: Action, entry: ActionEntry) -> None:
        values = {param.name.lstrip("?"): param.types for param in schema.params}
        for keys, text in [*_texts(entry.goal, ("goal",)), (("name",), entry.name)]:
            for placeholder in PLACEHOLDER.findall(text):
                table, _, name = placeholder.rpartition(".")
                where = ("actions", schema.name, *keys)
                if name not in values:
                    hint = nearest(name, values) or f"parameters: {', '.join(values)}"
                    raise self.mapping.fault(where, f"there is no parameter '{name}'", hint)
                if table:
                    self._check_table(table, self.problem.objects_of(values[name]), where)

    def _check_table(
        self, table: str, objects: Sequence[str], where: tuple[str | int, ...]
    ) -> None:
        tables = self.mapping.tables
        if table not in tables:
            hint = nearest(table, tables) or f"add [tables.{table}]"
            raise self.mapping.fault(where, f"there is no table '{table}'", hint)
        missing = [name for name in objects if name not in tables[table]]
        if missing:
            hint = f"add {missing[0]} = ... to it"
            message = f"there is no entry for {', '.join(missing)}"
            raise self.mapping.fault(("tables", table), message, hint)

    def entry(self, action: str) -> ActionEntry | None:
        """Return the entry of an action; None if there is none."""
        return self.mapping.actions.get(action)

    def order(self, action: str, args: Sequence[str]) -> dict[str, JsonValue]:
        """Return the action server and the goal for a ground action."""
        entry, schema = self.mapping.actions[action], self.problem.domain.schemas[action]
        names = (param.name.lstrip("?") for param in schema.params)
        bound = dict(zip(names, args, strict=True))
        return {
            "type": entry.type, "name": str(self._fill(entry.name, bound)),
            "goal": self._fill(entry.goal, bound), "done": entry.done,
        }  # fmt: skip

    def samples(self) -> Iterator[tuple[str, dict[str, JsonValue]]]:
        """Yield an order for each action of each robot, with any objects: what can be checked."""
        for name in self.mapping.actions:
            params = self.problem.domain.schemas[name].params
            for agent in self.agents:
                choices = [self.problem.objects_of(param.types) for param in params]
                if all(choices):
                    first = [agent if agent in objects else objects[0] for objects in choices]
                    yield name, self.order(name, first)

    def _fill(self, value: JsonValue, bound: ParameterObjects) -> JsonValue:
        """Return a goal with its placeholders filled in."""
        if isinstance(value, str):
            whole = PLACEHOLDER.fullmatch(value)
            if whole is not None:
                return self._filled(whole[1], bound)
            return PLACEHOLDER.sub(lambda match: str(self._filled(match[1], bound)), value)
        if isinstance(value, Mapping):
            return {key: self._fill(one, bound) for key, one in value.items()}
        if isinstance(value, Sequence):
            return [self._fill(one, bound) for one in value]
        return value

    def _filled(self, placeholder: str, bound: ParameterObjects) -> JsonValue:
        table, _, name = placeholder.rpartition(".")
        return self.mapping.tables[table][bound[name]] if table else bound[name]

    # Topics.

    def _check_topic(self, n: int, topic: TopicEntry) -> None:
        where = ("topics", n, topic.says)
        words = topic.text.lower().split()
        if topic.agent and topic.agent not in self.problem.agents:
            hint = nearest(topic.agent, self.problem.agents)
            raise self.mapping.fault(("topics", n, "agent"), f"no agent '{topic.agent}'", hint)
        if topic.near is not None:
            self._check_near(n, topic)
        try:
            if topic.says == "fact":
                self._check_fact(words)
            elif topic.says == "value" and "{" not in topic.text:
                check_function(tuple(words), self.problem)
        except UsageError as error:
            raise self.mapping.fault(where, error.message, error.hint) from None

    def _check_fact(self, words: Sequence[str]) -> None:
        predicates = self.problem.domain.predicates
        if not words or words[0] not in predicates:
            name = words[0] if words else ""
            raise UsageError(f"there is no predicate '{name}'", hint=nearest(name, predicates))
        params = predicates[words[0]].params
        if len(params) != len(words) - 1:
            raise UsageError(f"'{words[0]}' takes {len(params)} objects, not {len(words) - 1}")
        for word, param in zip(words[1:], params, strict=True):
            objects = self.problem.objects_of(param.types)
            if "{" not in word and word not in objects:
                raise UsageError(f"there is no object '{word}'", hint=nearest(word, objects))

    def _check_near(self, n: int, topic: TopicEntry) -> None:
        assert topic.near is not None
        where = ("topics", n, "near")
        self._check_table(topic.near.table, (), where)
        for name, entry in self.mapping.tables[topic.near.table].items():
            if _position(entry) is None:
                message = f"'{name}' has no position with x and y"
                raise self.mapping.fault(("tables", topic.near.table, name), message)

    def read(self, n: int, fields: Mapping[str, JsonValue]) -> msg.LinkMessage | None:
        """Return what a message of a topic means; None if it says nothing about the problem."""
        topic = self.mapping.topics[n]
        if topic.says == "fact":
            return self._fact(topic, fields)
        if topic.says == "value":
            words = tuple(str(self._field(topic.text, fields)).lower().split())
            value = fields.get(topic.field)
            is_number = isinstance(value, int | float) and not isinstance(value, bool)
            if not is_number or not math.isfinite(value):  # type: ignore[arg-type]
                return msg.BadLine(f"topic {topic.name}: {topic.field} is no number")
            return msg.ValuesSensed({words: value})  # type: ignore[dict-item]
        value = fields.get(topic.text)
        if topic.says == "stop":
            return msg.StopPressed(f"topic {topic.name}") if value else msg.StopReleased()
        text = str(value).strip()
        if topic.says == "said":
            return msg.PersonSaid(topic.agent, text) if text else None
        words = tuple(text.strip("()").lower().split())
        return msg.PersonBegun(topic.agent, words[0], words[1:]) if words else None

    def _field(self, text: str, fields: Mapping[str, JsonValue]) -> str:
        return PLACEHOLDER.sub(lambda match: str(fields.get(match[1], "")), text)

    def _fact(self, topic: TopicEntry, fields: Mapping[str, JsonValue]) -> msg.LinkMessage | None:
        """Return the fact of a message; others of its kind do not hold."""
        values = dict(fields)
        if topic.near is not None:
            values["near"] = self._nearest(topic, fields)
        fact = tuple(self._field(topic.text, values).lower().split())
        if topic.field:
            holds = frozenset({fact}), frozenset[Fact]()
            return msg.FactsObserved(*(holds if fields.get(topic.field) else holds[::-1]))
        others = frozenset(self._alike(topic.text.lower().split())) - {fact}
        if "" in values.values() or len(fact) != len(topic.text.split()):
            return msg.FactsObserved(frozenset(), others)  # none of them holds: it is elsewhere
        return msg.FactsObserved(frozenset({fact}), others)

    def _alike(self, words: Sequence[str]) -> Iterator[Fact]:
        """Yield every fact that a template with placeholders can become."""
        facts: list[Fact] = [(words[0],)]
        for word, param in zip(words[1:], self.problem.domain.predicates[words[0]].params,
                               strict=True):  # fmt: skip
            objects = self.problem.objects_of(param.types) if "{" in word else (word,)
            facts = [(*fact, name) for fact in facts for name in objects]
        yield from facts

    def _nearest(self, topic: TopicEntry, fields: Mapping[str, JsonValue]) -> str:
        """Return the object at a position; "" if none is near."""
        assert topic.near is not None
        here = _position(fields.get(topic.near.field))
        if here is None:
            return ""
        places = self.mapping.tables[topic.near.table].items()
        distance, name = min((math.dist(here, _position(p) or here), name) for name, p in places)
        return name if distance <= topic.near.within else ""


def _texts(
    value: JsonValue, keys: tuple[str | int, ...]
) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Yield every text in a value, and the way to it."""
    if isinstance(value, str):
        yield keys, value
    elif isinstance(value, Mapping):
        for key, one in value.items():
            yield from _texts(one, (*keys, key))
    elif isinstance(value, Sequence):
        for one in value:
            yield from _texts(one, keys)


def _position(value: JsonValue) -> tuple[float, float] | None:
    """Return x and y of a position or pose; None if it has none."""
    if not isinstance(value, Mapping):
        return None
    if isinstance(value.get("position"), Mapping):
        return _position(value["position"])
    x, y = value.get("x", 0.0), value.get("y", 0.0)
    if ("x" in value or "y" in value) and all(isinstance(one, int | float) for one in (x, y)):
        return float(x), float(y)  # type: ignore[arg-type]
    return None
