"""The episodes of the study: people whose goal changes and whose state drifts, and a robot."""

from __future__ import annotations

from dataclasses import asdict, replace

from hrcplan.collaboration.collaborate import simulated
from hrcplan.collaboration.history import AskedGoal, EndedAction, actions_in
from hrcplan.collaboration.run import CompanionRun
from hrcplan.episodes.episode import PATIENCE, REACHED, STUCK, UNFINISHED
from hrcplan.episodes.humans import Course
from hrcplan.episodes.measures import changes, guesses, n_wasted
from hrcplan.episodes.traces import answer_of
from hrcplan.execution import events as ev
from hrcplan.inference.traces import ALL_HUMANS, ActionTrace, TracedEpisode
from hrcplan.studies.collaboration import scenario
from hrcplan.studies.collaboration.measures import DETAILS, MEASURES
from hrcplan.studies.collaboration.record import GuessLog, record_of
from hrcplan.studies.collaboration.scenario import StudyTask
from hrcplan.studies.study import Cell, Seed, StudyOptions, StudyRow

UNIT = ("first", "second")
ORACLE = "joint-oracle"
COLUMNS = (*UNIT, "change", "ending", *MEASURES, *DETAILS)
ENDINGS = (REACHED, STUCK, UNFINISHED)


def simulate(options: StudyOptions, cell: Cell, seed: Seed) -> StudyRow:
    """Return the row of one episode: what was drawn, and its measures."""
    return _row(_Collaboration(options, cell, seed))


def simulate_with_trace(
    options: StudyOptions, cell: Cell, seed: Seed
) -> tuple[StudyRow, ActionTrace]:
    """Return the same, and what was done and believed."""
    episode = _Collaboration(options, cell, seed)
    return _row(episode), episode.trace()


class _Collaboration:
    """A finished collaboration of a run, and its record."""

    def __init__(self, options: StudyOptions, cell: Cell, seed: Seed) -> None:
        case, method = map(str, cell)
        name, human = scenario.split_case(case)
        self.task = scenario.task_of(*scenario.files_of(options, name))
        self.course = scenario.course(self.task.bank, human, seed)
        setup = self.task.setup(options, method, seed)
        mean_s = self.task.prices.mean_duration_s
        lasts_s = _n_steps(self.task, self.course) * mean_s / len(setup.slots)
        nature = scenario.nature(setup, human, seed, lasts_s)
        parts = simulated(
            setup, self.task.bank, self.course, options["chooser"],
            lambda bank: self.task.assistant(setup), nature,
        )  # fmt: skip
        self.log = GuessLog(parts.adviser)
        self.run = parts.run(watch=self.log.watch)
        self.record = record_of(self.run, parts, self.course, self.log)

    def trace(self) -> ActionTrace:
        """Return what was done, with the belief after each action of people."""
        bank = self.task.bank
        actions = self.log.trace(bank.goals.problem)
        answers = {ALL_HUMANS: answer_of(bank, self.course)}
        return replace(actions, episode=TracedEpisode(bank.names, None, answers))


def _row(episode: _Collaboration) -> StudyRow:
    task, run, record = episode.task, episode.run, episode.record
    names = [task.bank.names[goal] for goal in episode.course.goals]
    return {
        "first": names[0],
        "second": names[1] if len(names) > 1 else None,
        "change": " ".join(map(str, episode.course.turns)),
        "ending": record.ending,
        **{f"{ending}_pct": 100.0 * (record.ending == ending) for ending in ENDINGS},
        **_costs(task, run, episode.course, record.ending == REACHED),
        **_shares(run),
        **_only(asdict(guesses(record))),
        **_only(asdict(changes(record))),
        "wasted_robot_steps": n_wasted(record),
    }


def _n_steps(task: StudyTask, course: Course) -> int:
    """Return how many actions the goals of a course take one after the other."""
    return sum(task.bank.graphs[goal].n_steps for goal in course.goals)


def _costs(
    task: StudyTask, run: CompanionRun, course: Course, is_reached: bool
) -> dict[str, float]:
    """Return what was paid: the metric of all attempts and questions; at least the cap if in vain.

    An attempt costs what the action costs while every agent state is low, also if it fails.
    """
    prices, actions = task.prices, list(actions_in(run.history))
    of_action = [prices.costs.get(action.words, prices.mean_cost) for action in actions]
    of_people = [c for c, action in zip(of_action, actions, strict=True) if not action.is_robot]
    n_questions = sum(isinstance(mark, AskedGoal) for mark in run.history)
    cost = sum(of_action)
    makespan_s = run.run.counts.last_end_s
    if not is_reached:
        n_most = PATIENCE * _n_steps(task, course)
        cost = max(cost, n_most * prices.mean_cost)
        makespan_s = max(makespan_s, n_most * prices.mean_duration_s)
    asking = n_questions * float(scenario.data()["study"]["question_price"]) * prices.mean_cost
    return {
        "team_cost": round(prices.total(cost + asking, makespan_s), 6),
        "makespan_s": round(makespan_s, 6),
        "human_cost": round(sum(of_people), 6),
        "questions": n_questions,
    }


def _shares(run: CompanionRun) -> dict[str, float]:
    """Return the measures of failure anticipation: who attempted how much, and what failed."""
    outcomes = {m.number: m.outcome for m in run.history if isinstance(m, EndedAction)}
    actions = list(actions_in(run.history))
    ended = [a for a in actions if outcomes.get(a.number) in (ev.DONE, ev.FAILED)]
    done = [a for a in ended if outcomes[a.number] == ev.DONE]
    return {
        "failed_pct": _pct(len(ended) - len(done), len(ended)),
        "assigned_human_pct": _pct(sum(not a.is_robot for a in actions), len(actions)),
        "successful_human_pct": _pct(sum(not a.is_robot for a in done), len(done)),
        "n_failed": len(ended) - len(done),
        "n_actions": len(actions),
    }


def _pct(part: int, whole: int) -> float:
    return 100.0 * part / max(1, whole)


def _only(values: dict[str, float]) -> dict[str, float]:
    """Return the values that are measures of this study."""
    return {name: value for name, value in values.items() if name in COLUMNS}
