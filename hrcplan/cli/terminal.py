"""A person at a terminal, or a program at the other end of a pipe, in a collaboration."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence

from hrcplan.assistance.joint_help import JointState
from hrcplan.cli import output
from hrcplan.cli.lines import MAX_LINE, InputLines, InterruptedInputError
from hrcplan.cli.narrator import Narrator, goals_text
from hrcplan.collaboration import events as shared
from hrcplan.collaboration.events import PersonEvent
from hrcplan.collaboration.history import History
from hrcplan.collaboration.persons import NO_WORDS, YES_WORDS, idle_wait_s
from hrcplan.collaboration.reading import ActionWords
from hrcplan.collaboration.run import CompanionRun
from hrcplan.core.numbers import number_text
from hrcplan.core.steady_clock import SteadyClock
from hrcplan.errors import UsageError
from hrcplan.execution import events as ev
from hrcplan.pddl.model import FluentKey, fact_text

N_SHOWN = 6  # steps that are offered before each of the person's turns
N_GOALS_LISTED = 12
MOST_LOOK_S = 1.0  # between two looks at what is typed; more is a jump of the clock
N_ALONE = 2  # words of an agent state that depends on its agent alone
GREETING = "· say what you do in your own words or by number; Enter to wait, help for more"
HELP = """Say what you do in your own words{step}, or give its number.
Enter   do nothing now
NAME:   whose step it is, if several people are here
steps   what can be done now
undo    my last step was not done
failed  my last step was done, but failed
goals   what the robot believes
why     what the robot weighs
state   what holds now{state}
pause   the robot begins nothing more
stop    it also stops what it does
go      it goes on
quit    end"""


class IdleAlarm:
    """Ends a wait for a line when something happens, or nothing has happened for some seconds.

    Args:
        wait_s: For how long.
        interrupt: Waits, and returns whether something has happened; None if nothing can.
        real: The clock.
    """

    def __init__(
        self, wait_s: float, interrupt: Callable[[float], bool] | None,
        real: Callable[[], float] = time.monotonic,
    ) -> None:  # fmt: skip
        self.wait_s, self._interrupt = wait_s, interrupt
        self._clock = SteadyClock(real, most_s=MOST_LOOK_S)
        self._end_s = self._clock() + wait_s
        self.is_over = False

    def __call__(self, seconds: float) -> bool:
        """Wait for some seconds; return whether the wait for a line is to end."""
        if self._interrupt is None:
            time.sleep(seconds)
        elif self._interrupt(seconds):
            return True
        self.is_over = self._clock() >= self._end_s
        return self.is_over


class Terminal:
    """Reads what people say; acts for all of them.

    Args:
        narrator: Prints what happens.
        lines: What is typed.
    """

    is_live = True

    def __init__(self, narrator: Narrator, lines: InputLines) -> None:
        self.narrator, self.lines = narrator, lines
        self.setup, self.adviser = narrator.setup, narrator.adviser
        self.interrupt: Callable[[float], bool] | None = None
        self._listed: list[ActionWords] = []
        self._is_greeted = output.JSON
        self._offered: tuple[History, tuple[str, ...]] | None = None
        self._commands: Mapping[str, Callable[[CompanionRun, list[str]], PersonEvent | None]] = {
            "undo": self._undo, "failed": self._failed, "why": self._why, "goals": self._goals,
            "steps": self._steps, "state": self._state, "help": self._help,
            "pause": lambda run, _: shared.Paused(run.t),
            "stop": lambda run, _: shared.Stopped(run.t),
            "go": lambda run, _: shared.Continued(run.t),
            "quit": lambda run, _: ev.StopAsked(run.t, "quit"),
        }  # fmt: skip

    def act(self, run: CompanionRun, agents: tuple[str, ...]) -> tuple[PersonEvent, ...]:
        """Return what these people do now; nothing if something else happens meanwhile.

        Raises:
            EndOfInputError: if there are no more lines.
        """
        if self.lines.is_terminal and not self._is_greeted:
            self._say(GREETING)
        self._is_greeted = True
        if run.question is None and self._offered != (run.history, agents):
            self._offer(run, agents)
            self._offered = run.history, agents
        while True:
            prompt = f"{agents[0]}> " if len(self.setup.people) > 1 else "> "
            alarm = self._alarm(run)
            try:
                text = self.lines.next(prompt, self.interrupt if alarm is None else alarm)
            except InterruptedInputError:
                is_idle = alarm is not None and alarm.is_over
                return (shared.Idle(run.t, alarm.wait_s),) if is_idle and alarm else ()
            self._offered = None
            event = self._event(run, agents, text)
            if event is not None:
                return (event,)

    def _alarm(self, run: CompanionRun) -> IdleAlarm | None:
        """Return what ends a long wait for a line at a terminal; None if it says nothing."""
        wait_s = idle_wait_s(run, self.setup) if self.lines.is_terminal else None
        return None if wait_s is None else IdleAlarm(wait_s, self.interrupt)

    def _event(self, run: CompanionRun, agents: tuple[str, ...], text: str) -> PersonEvent | None:
        """Return what a line means; None if it is answered here and now."""
        if self.lines.is_too_long:
            return self._say(f"· a line has at most {MAX_LINE} characters")
        if not text:
            return shared.Passed(run.t, agents[0])
        words = text.lower().split()
        if run.question is not None:
            answer = self._answer(run, run.question, words)
            if answer is not None:
                return answer
        elif len(words) == 1 and words[0] in (YES_WORDS[0], NO_WORDS[0]):
            return self._say("· nothing was asked; 'quit' ends")
        if words[0] in self._commands and (len(words) == 1 or words[0] == "state"):
            return self._commands[words[0]](run, words[1:])
        return self._step(run, text)

    def _answer(
        self, run: CompanionRun, question: shared.Ask, words: list[str]
    ) -> PersonEvent | None:
        if question.question == shared.DONE and words[0] in (*YES_WORDS, *NO_WORDS):
            choice = shared.YES if words[0] in YES_WORDS else shared.NO
            return shared.Answered(run.t, choice)
        if (
            question.question == shared.WHICH
            and len(question.options) == 1
            and words[0] in YES_WORDS
        ):
            return shared.Answered(run.t, question.options[0])
        if question.question == shared.DONE:
            return None
        options = question.options
        if question.question == shared.GOAL:
            goal = _named(" ".join(words), options)
            if goal is not None:
                return shared.Answered(run.t, goal)
        if words[0].isdecimal() and 0 <= (place := int(words[0][:4]) - 1) < len(options):
            return shared.Answered(run.t, options[place])
        return None

    def _step(self, run: CompanionRun, text: str) -> PersonEvent | None:
        agent = ""
        name, colon, rest = text.partition(":")
        if colon and name.strip().lower() in self.setup.people:
            agent, text = name.strip().lower(), rest.strip()
            if not text:
                return shared.Passed(run.t, agent)
        elif colon and self._is_unknown(name.strip().lower()):
            return self._say(f"· there is no {name.strip()}: {', '.join(self.setup.people)}")
        if not text.isdecimal():
            return shared.Said(run.t, agent, text)
        place = int(text[:6]) - 1
        if not 0 <= place < len(self._listed):
            return self._say(f"· there is no step {text[:6]}; 'steps' lists them")
        action = self._listed[place]
        return shared.Begun(run.t, agent, action[0], action[1:])

    def _is_unknown(self, name: str) -> bool:
        """Return whether a name before a colon is no agent, where several people act."""
        is_word = len(name.split()) == 1
        return is_word and len(self.setup.people) > 1 and name not in self.setup.robots

    def _offer(self, run: CompanionRun, agents: tuple[str, ...]) -> None:
        """Print the likeliest steps, with numbers."""
        possible = self.adviser.possible(agents)
        prior = self.adviser.prior(possible) if self.adviser.is_ready else {}
        requests = [
            (r.step.schema.name, *r.step.binding.values())
            for r in run.running
            if r.index is not None and r.step.agent in agents
        ]
        others = sorted(
            (words for words in possible if words not in requests),
            key=lambda words: -prior.get(words, 0.0),
        )
        self._listed = [*requests, *others]
        if output.JSON:
            return
        shown = [f"{n} {self.narrator.words(w)}" for n, w in enumerate(self._listed[:N_SHOWN], 1)]
        if len(self._listed) > N_SHOWN:
            shown.append(f"({len(self._listed) - N_SHOWN} more: steps)")
        output.result(output.fold("  ".join(item.replace(" ", output.NO_BREAK) for item in shown)))

    def _say(self, text: str) -> PersonEvent | None:
        """Print an answer; there is no event."""
        if output.JSON:
            output.document({"message": text.removeprefix("· ")})
        else:
            output.result("\n".join(map(output.fold, text.split("\n"))))
        return None

    # Commands.

    def _undo(self, run: CompanionRun, words: list[str]) -> PersonEvent | None:
        last = run.last_reported
        if last is None:
            return self._say("· there is nothing to take back")
        return shared.Undone(run.t, last.number)

    def _failed(self, run: CompanionRun, words: list[str]) -> PersonEvent | None:
        last = run.last_reported
        if last is None:
            return self._say("· there is no step that could have failed")
        return shared.Undone(run.t, last.number, attempted=True)

    def _help(self, run: CompanionRun, words: list[str]) -> PersonEvent | None:
        step = f' ("{self.narrator.words(self._listed[0])}")' if self._listed else ""
        state = f"; state {self._example()}: how an agent is" if self._example() else ""
        return self._say(HELP.format(step=step, state=state))

    def _example(self) -> str:
        """Return how a person says how an agent of this domain is; "" if agents have no state."""
        agents = self.setup.model.agents
        if not agents.low:
            return ""
        key = min(agents.low, key=len)
        return f"{' '.join(key)} {number_text(agents.value_range(key)[1])}"

    def _steps(self, run: CompanionRun, words: list[str]) -> None:
        if output.JSON:
            output.document({"steps": [fact_text(step) for step in self._listed]})
            return
        for n, step in enumerate(self._listed, start=1):
            output.result(f"{n:4}  {self.narrator.words(step)}")

    def _goals(self, run: CompanionRun, words: list[str]) -> PersonEvent | None:
        if self.setup.has_one_goal:
            return self._say(f"· there is one goal: {next(iter(self.setup.goals))}")
        state = self.adviser.fold.state(run.history)
        goals = self.adviser.likeliest(state)
        none = state.none if isinstance(state, JointState) else 0.0
        if output.JSON:
            output.document({"goals": dict(goals), **({"none_of_these": none} if none else {})})
            return None
        for name, p in goals[:N_GOALS_LISTED]:
            output.result(f"{100 * p:5.1f} %  {name}")
        if none:
            self._say(f"· or, with {100 * none:.0f} %, none of these")
        return None

    def _why(self, run: CompanionRun, words: list[str]) -> PersonEvent | None:
        if self.setup.has_one_goal:
            return self._say("· the robot follows the plan that is cheapest as things are")
        explanation = self.adviser.explain(self.adviser.fold.state(run.history))
        if explanation is None:
            return self._say(f"· the robot '{self.setup.method}' does not say why")
        lines = [f"· believes {goals_text(explanation.goals, N_GOALS_LISTED)}"]
        for candidate in explanation.candidates:
            helps = ", ".join(goal for goal, _ in candidate.helps)
            value = f"value {candidate.value:6.2f}, saves {candidate.saves:5.2f} steps"
            lines.append(f"  {candidate.action:32} {value}{f', for {helps}' if helps else ''}")
        return self._say("\n".join(lines))

    def _state(self, run: CompanionRun, words: list[str]) -> PersonEvent | None:
        if words:
            return self._state_told(run, words)
        agents = self.setup.model.agents
        values = {" ".join(k): run.run.sensed_values.get(k, low) for k, low in agents.low.items()}
        facts = sorted(map(fact_text, self.setup.model.actions.changing(run.run.state)))
        if output.JSON:
            numbers = {key: float(value) for key, value in values.items()}
            output.document({"facts": facts, "agent_state": numbers})
            return None
        shown = (fact.replace(" ", output.NO_BREAK) for fact in facts)
        output.result(output.fold(" ".join(shown)) or "· no changing fact holds")
        told = [
            f"{' '.join(key)} {number_text(run.run.sensed_values.get(key, low))}"
            for key, low in agents.low.items()
            if len(key) == N_ALONE or key in run.run.sensed_values
        ]
        return self._say("· " + ", ".join(told)) if told else None

    def _state_told(self, run: CompanionRun, words: list[str]) -> PersonEvent | None:
        """Return what a person says about an agent, as in ``state FUNCTION AGENT NUMBER``."""
        agents = self.setup.model.agents
        try:
            key = _element(tuple(words[:-1]), agents.functions)
            agents.check(key, float(words[-1]))
        except ValueError:
            return self._say(f"· say it as in: state {self._example() or 'FUNCTION AGENT NUMBER'}")
        except UsageError as error:
            known = ", ".join(" ".join(one) for one in list(agents.low)[:N_SHOWN])
            hint = f" (there are: {known})" if known else " (this domain has no agent states)"
            return self._say(f"· {error.message}{hint}")
        return shared.StateTold(run.t, {key: float(words[-1])})


def _named(text: str, options: Sequence[str]) -> str | None:
    """Return the option that a text names, or the only one that has all its words.

    >>> _named("bean pasta", ("pasta-bean", "pasta-tomato"))
    'pasta-bean'
    """
    words = set(text.replace("-", " ").split())
    fitting = [o for o in options if words <= set(o.lower().replace("-", " ").split())]
    exact = [option for option in fitting if option.lower() == text]
    return (exact or fitting)[0] if exact or len(fitting) == 1 else None


def _element(words: FluentKey, functions: frozenset[str]) -> FluentKey:
    """Return words as an element of agent state: the function may stand anywhere.

    >>> _element(("human", "motivation"), frozenset({"motivation"}))
    ('motivation', 'human')
    """
    name = next((word for word in words if word in functions), None)
    if name is None:
        return words
    return (name, *(word for word in words if word != name))
