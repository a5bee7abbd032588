"""What happens in a run as entries for a page: bars, words, belief, facts, agent states.

An entry is a JSON object for one step of the machine; ``n`` is the number of its line in the
journal. A page folds entries, so a live page, one that reconnects and a replay show the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from hrcplan.collaboration import events as shared
from hrcplan.collaboration.events import SharedCommand, SharedEvent
from hrcplan.core.numbers import Number
from hrcplan.core.text import plural
from hrcplan.execution import events as ev
from hrcplan.execution.action_model import ActionModel
from hrcplan.pddl.conventions import people, robots
from hrcplan.pddl.model import Fact, FluentKey, Problem
from hrcplan.pddl.semantics import LiftedState
from hrcplan.plans import lane

StoryEntry = dict[str, Any]
_SELF_BEGUN = (shared.Begun, shared.Read, shared.Answered)
CHANGE, PLAN, REASON, QUESTION, NOTE, FAILED, STATE, SAID, END = (
    "change", "plan", "reason", "question", "note", "failed", "state", "said", "end",
)  # fmt: skip


class Story:
    """Collects the entries of one run.

    Args:
        problem: The problem; its agents are the lanes.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.entries: list[StoryEntry] = []
        self._actions = ActionModel(problem)
        self._robots, self._people = robots(problem), people(problem)
        self._facts = self._actions.changing(self._actions.initial())
        self._bars: dict[int, StoryEntry] = {}
        self.line = 0
        self._n_plans = 0

    def add(
        self, state: LiftedState, event: SharedEvent, commands: tuple[SharedCommand, ...]
    ) -> StoryEntry | None:
        """Return the entry of one step of the machine, and keep it; None if nothing is to show.

        Args:
            state: The state after the step.
            event: What happened.
            commands: What the machine decided.
        """
        self.line += 2  # the event is one line of the journal, and what was decided the next
        entry: StoryEntry = {}
        notes = [*self._event_notes(event), *self._command_notes(commands)]
        if isinstance(event, shared.Chosen) and event.goals:
            notes.append((REASON, self._reason(event, commands)))
        if notes:
            entry["notes"] = [{"kind": kind, "text": text} for kind, text in notes]
        bars = [*self._changed_bars(event, commands)]
        if bars:
            entry["bars"] = bars
        entry |= self._facts_entry(state)
        match event:
            case shared.Chosen() if event.goals:
                entry["belief"] = [[name, round(p, 4)] for name, p in event.goals]
            case shared.Undone(number=number) if not event.attempted:
                entry["undone"] = number
            case ev.Sensed(values=values) | shared.StateTold(values=values):
                entry["values"] = _values(values)
        if not entry:
            return None
        entry = {"n": self.line, "t": round(float(event.t), 3), **entry}
        self.entries.append(entry)
        return entry

    # Bars.

    def _changed_bars(
        self, event: SharedEvent, commands: Iterable[SharedCommand]
    ) -> Iterable[StoryEntry]:
        match event:
            case ev.Ended(t, number, outcome):
                yield from self._closed(number, t, outcome)
            case ev.Overdue(t, number):
                yield from self._closed(number, t, ev.FAILED)
            case shared.Undone(t, number, True):
                yield from self._closed(number, t, ev.FAILED, also_done=True)
        for command in commands:
            if isinstance(command, ev.Dispatch):
                yield self._opened(command, is_asked=not isinstance(event, _SELF_BEGUN))

    def _opened(self, command: ev.Dispatch, is_asked: bool) -> StoryEntry:
        bar = {
            "number": command.number, "agent": command.agent,
            "action": command.action, "args": self._others(command.agent, command.args),
            "start": command.t, "end": command.t + command.duration_s, "outcome": "",
        }  # fmt: skip
        if is_asked and command.agent in self._people:
            bar["asked"] = True
        self._bars[command.number] = bar
        return dict(bar)

    def _closed(
        self, number: int, t: float, outcome: str, also_done: bool = False
    ) -> Iterable[StoryEntry]:
        bar = self._bars.get(number)
        if bar is not None and (not bar["outcome"] or also_done):
            bar |= {"outcome": outcome} if also_done else {"outcome": outcome, "end": t}
            yield dict(bar)

    def _others(self, agent: str, args: tuple[str, ...]) -> list[str]:
        rest = list(args)
        if agent in rest:
            rest.remove(agent)
        return rest

    # Words.

    def words(self, agent: str, action: str, args: tuple[str, ...]) -> str:
        """Return an action in words, without the agent that does it."""
        return " ".join([action, *self._others(agent, args)])

    def words_of(self, text: str) -> str:
        """Return an action that is written as in PDDL in words."""
        name, *args = text.strip("()").split()
        return self.words(lane(args, self.problem) or "", name, tuple(args))

    def _event_notes(self, event: SharedEvent) -> Iterable[tuple[str, str]]:
        match event:
            case ev.Ended(_, number, ev.FAILED) if number in self._bars:
                yield FAILED, f"{self._bar_text(number)} failed"
            case ev.Overdue(_, number) if number in self._bars:
                yield FAILED, f"{self._bar_text(number)} did not end in time"
            case shared.Undone(_, number, attempted) if number in self._bars:
                what = "failed" if attempted else "is taken back"
                yield FAILED, f"{self._bar_text(number)} {what}"
            case shared.Said(_, agent, text):
                yield SAID, f"{agent or 'you'}: {text}"
            case shared.Answered(_, choice):
                is_action = choice.startswith("(")
                yield SAID, f"answer: {self.words_of(choice) if is_action else choice}"
            case shared.Paused():
                yield NOTE, "the robot waits"
            case shared.Continued():
                yield NOTE, "the robot goes on"
            case ev.Sensed(_, values) | shared.StateTold(_, values):
                shown = (f"{' '.join(k)} is {v:g}" for k, v in _values_by_key(values).items())
                yield STATE, ", ".join(shown)
            case ev.Happened(_, _, text):
                yield STATE, f"{text} comes by itself"
            case ev.Noticed(_, _, message):
                yield NOTE, message

    def _bar_text(self, number: int) -> str:
        bar = self._bars[number]
        return f"{bar['agent'] or 'robot'}: {' '.join([bar['action'], *bar['args']])}"

    def _command_notes(self, commands: Iterable[SharedCommand]) -> Iterable[tuple[str, str]]:
        for command in commands:
            match command:
                case ev.Tell(_, code, message):
                    yield (CHANGE if code == "goal-change" else NOTE), message
                case ev.AskPlan(reasons=reasons) if reasons:
                    yield PLAN, f"replanning: {'; '.join(reasons)}"
                case ev.Adopt():
                    yield PLAN, self._plan_text(command)
                case shared.Ask(_, question, options):
                    yield QUESTION, self.question_text(question, options)
                case ev.Finish(_, ending, why):
                    yield END, f"{ending}{f': {why}' if why else ''}"

    def _plan_text(self, command: ev.Adopt) -> str:
        self._n_plans += 1
        lanes = [lane(action.args, self.problem) for action in command.plan.actions]
        shares = ", ".join(f"{agent} {lanes.count(agent)}" for agent in self.problem.agents)
        name = f"plan {self._n_plans}" if self._n_plans > 1 else "plan"
        reason = f", because {command.why}" if command.why else ""
        return f"{name}: {plural(len(lanes), 'action')} ({shares}){reason}"

    def question_text(self, question: str, options: tuple[str, ...]) -> str:
        """Return a question to people in words."""
        if question == shared.DONE:
            return f"{', '.join(options)}: done. Was that all?"
        if question == shared.WHICH:
            return f"Which do you mean: {', '.join(map(self.words_of, options))}?"
        if question == shared.GOAL:
            return "What do you want to do?"
        return f"{question}: {', '.join(options)}?"

    def _reason(self, event: shared.Chosen, commands: tuple[SharedCommand, ...]) -> str:
        """Return what the robot does now, for which goals, and what it believes."""
        goals = ", ".join(f"{name} {100 * p:.0f} %" for name, p in event.goals[:3])
        goals = goals if event.claims else "none of the goals seems to be yours"
        dispatch = next((c for c in commands if isinstance(c, ev.Dispatch)), None)
        if dispatch is None:
            return f"robot {'asks' if event.asks else 'waits'} · {goals}"
        text = self.words(dispatch.agent, dispatch.action, dispatch.args)
        helps = f", for {', '.join(event.helps)}" if event.helps else ""
        because = f", because {event.takes_over}" if event.takes_over else ""
        return f"{dispatch.agent or 'robot'}: {text}{helps}{because} · {goals}"

    # Facts.

    def _facts_entry(self, state: LiftedState) -> StoryEntry:
        """Return which changing facts have come and gone."""
        facts = self._actions.changing(state)
        before, self._facts = self._facts, facts
        entry = {"plus": _texts(facts - before), "minus": _texts(before - facts)}
        return {key: words for key, words in entry.items() if words}


def _texts(facts: Iterable[Fact]) -> list[str]:
    return sorted(" ".join(fact) for fact in facts)


def _values_by_key(values: Mapping[FluentKey, float | Number]) -> dict[FluentKey, float]:
    return {key: float(value) for key, value in values.items()}


def _values(values: Mapping[FluentKey, float | Number]) -> dict[str, float]:
    return {" ".join(key): value for key, value in _values_by_key(values).items()}
