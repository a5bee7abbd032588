"""What happens in a collaboration, in words: one line for each thing that people should know."""

from __future__ import annotations

from collections.abc import Sequence

from hrcplan.cli import output
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.adviser import Adviser
from hrcplan.collaboration.events import SharedCommand, SharedEvent
from hrcplan.collaboration.reading import ActionWords
from hrcplan.collaboration.run import CompanionRun
from hrcplan.collaboration.setup import TURNS, CollaborationSetup
from hrcplan.core.text import plural
from hrcplan.execution import events as ev
from hrcplan.execution.codec import to_json
from hrcplan.plans import lane

N_GOALS = 3  # that are named after a step


def goals_text(goals: Sequence[tuple[str, float]], n: int = N_GOALS) -> str:
    """Return the likeliest goals with their probabilities.

    >>> goals_text([("soup", 0.904), ("stew", 0.096)])
    'soup 90 %, stew 10 %'
    """
    return ", ".join(f"{name} {100 * p:.0f} %" for name, p in goals[:n])


def _print(line: str) -> None:
    output.result(output.fold(line))


def _is_too_early(command: SharedCommand) -> bool:
    return isinstance(command, ev.Tell) and command.code == "not-your-turn"


class Narrator:
    """Prints what happens; as JSON one line for each event."""

    def __init__(self, setup: CollaborationSetup, adviser: Adviser) -> None:
        self.setup, self.adviser = setup, adviser
        self._words: dict[int, tuple[str, str]] = {}

    def watch(
        self, run: CompanionRun, event: SharedEvent, commands: tuple[SharedCommand, ...]
    ) -> None:
        """Print one step of the machine."""
        if output.JSON:
            output.document({"event": to_json(event), "commands": [to_json(c) for c in commands]})
            return
        self._event(event)
        for command in commands:
            self._command(command, event)
        if run.question is not None and any(_is_too_early(command) for command in commands):
            _print("· say no, and the robot goes on; then it is your turn")
        if isinstance(event, shared.Chosen):
            self._chosen(run, event, commands)

    def words(self, action: ActionWords) -> str:
        """Return an action in words; the only human, or robot, is not named."""
        agent = lane(action[1:], self.setup.problem)
        group = self.setup.robots if agent in self.setup.robots else self.setup.people
        left = list(action)
        if agent is not None and len(group) == 1:
            left.remove(agent)
        return " ".join(left)

    def _who(self, agent: str) -> str:
        if agent in self.setup.people and len(self.setup.people) == 1:
            return "you"
        return agent or "robot"

    def _who_waits(self, run: CompanionRun) -> str:
        """Return that the robots that were asked for a step wait; the only one is not named."""
        robots = run.step_request[0] if run.step_request else ()
        if len(self.setup.robots) == 1 or not robots:
            return "robot waits"
        return f"{' and '.join(robots)} {'waits' if len(robots) == 1 else 'wait'}"

    def _event(self, event: SharedEvent) -> None:
        match event:
            case ev.Ended(t, number, outcome) if number in self._words:
                who, words = self._words[number]
                if outcome == ev.FAILED:
                    _print(f"✗ {who}: {words} failed")
                elif outcome == ev.DONE and not self._is_in_turns():
                    _print(f"✓ {who}: {words} ({t:g} s)")
            case shared.Undone(_, number, attempted):
                _, words = self._words.get(number, ("", "your last step"))
                _print(f"· {words} {'failed' if attempted else 'is taken back'}")
            case shared.Paused():
                _print("· the robot waits until you say go")
            case shared.Stopped():
                _print("· the robot stops what it does, and waits until you say go")
            case shared.Continued():
                _print("· the robot goes on")
            case ev.Sensed(_, values) | shared.StateTold(_, values):
                shown = ", ".join(f"{' '.join(key)} is {float(v):g}" for key, v in values.items())
                _print(f"· {shown}")

    def _is_in_turns(self) -> bool:
        return self.setup.pace == TURNS and not self.setup.has_one_goal

    def _command(self, command: SharedCommand, event: SharedEvent) -> None:
        match command:
            case ev.Dispatch():
                self._dispatched(command, event)
            case ev.Tell(_, _, message):
                _print(f"· {message}")
            case ev.Adopt(_, plan, why):
                lanes = [lane(action.args, self.setup.problem) for action in plan.actions]
                shares = ", ".join(
                    f"{a} {lanes.count(a)}" for a in (*self.setup.people, *self.setup.robots)
                )
                reason = f", because {why}" if why else ""
                _print(f"· plan: {plural(len(lanes), 'action')} ({shares}){reason}")
            case shared.Ask(_, shared.DONE, options):
                _print(f"· done: {', '.join(options)}. Was that all? (yes, no, or go on)")
            case shared.Ask(_, shared.GOAL, options):
                _print("· what do you want to do?")
                for n, option in enumerate(options, start=1):
                    _print(f"  {n}  {option}")
            case shared.Ask(_, _, (option,)):
                words = self.words(tuple(option.strip("()").split()))
                _print(f"· do you mean: {words}? (yes, or say it in other words)")
            case shared.Ask(_, _, options):
                _print("· which of these?")
                for n, option in enumerate(options, start=1):
                    _print(f"  {n}  {self.words(tuple(option.strip('()').split()))}")

    def _dispatched(self, command: ev.Dispatch, event: SharedEvent) -> None:
        words = self.words((command.action, *command.args))
        self._words[command.number] = self._who(command.agent), words
        is_asked = command.agent in self.setup.people and not isinstance(
            event, shared.Begun | shared.Read | shared.Answered
        )
        if isinstance(event, shared.Chosen):
            return
        who = self._who(command.agent)
        _print(f"→ {who}, please: {words}" if is_asked else f"{who}: {words}")

    def _chosen(
        self, run: CompanionRun, event: shared.Chosen, commands: tuple[SharedCommand, ...]
    ) -> None:
        dispatch = next((c for c in commands if isinstance(c, ev.Dispatch)), None)
        goals = goals_text(event.goals) if event.claims else "none of the goals seems to be yours"
        if dispatch is None:
            if self._is_in_turns() and event.asks:
                return
            if self._is_in_turns():
                _print(f"{self._who_waits(run)} · {goals}")
            return
        words = self.words((dispatch.action, *dispatch.args))
        helps = f", for {', '.join(event.helps)}" if event.helps else ""
        because = f", because {event.takes_over}" if event.takes_over else ""
        _print(f"{self._who(dispatch.agent)}: {words}{helps}{because} · {goals}")
