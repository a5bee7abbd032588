"""The episodes of the study: people whose goal changes and whose state drifts, and a robot."""

from __future__ import annotations

from dataclasses import asdict

from hrcplan.collaboration.collaborate import simulated
from hrcplan.collaboration.history import AskedGoal, EndedAction, actions_in
from hrcplan.collaboration.run import CompanionRun
from hrcplan.episodes.episode import PATIENCE, REACHED, STUCK, UNFINISHED, EpisodeRecord
from hrcplan.episodes.humans import Course
from hrcplan.episodes.measures import changes, guesses, n_wasted
from hrcplan.execution import events as ev
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
    case, method = map(str, cell)
    name, human = scenario.split_case(case)
    task = scenario.task_of(*scenario.files_of(options, name))
    course = scenario.course(task.bank, human, seed)
    run, record = _play(task, options, human, method, course, seed)
    names = [task.bank.names[goal] for goal in course.goals]
    return {
        "first": names[0],
        "second": names[1] if len(names) > 1 else None,
        "change": " ".join(map(str, course.turns)),
        "ending": record.ending,
        **{f"{ending}_pct": 100.0 * (record.ending == ending) for ending in ENDINGS},
        **_costs(task, run, course, record.ending == REACHED),
        **_shares(run),
        **_only(asdict(guesses(record))),
        **_only(asdict(changes(record))),
        "wasted_robot_steps": n_wasted(record),
    }


def _play(
    task: StudyTask, options: StudyOptions, human: str, method: str, course: Course, seed: Seed
) -> tuple[CompanionRun, EpisodeRecord]:
    """Return a finished collaboration, and its record."""
    setup = task.setup(options, method, seed)
    lasts_s = _n_steps(task, course) * task.prices.mean_duration_s / len(setup.slots)
    nature = scenario.nature(setup, human, seed, lasts_s)
    parts = simulated(
        setup, task.bank, course, options["chooser"], lambda bank: task.assistant(setup), nature
    )
    log = GuessLog(parts.adviser)
    run = parts.run(watch=log.watch)
    return run, record_of(run, parts, course, log)


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
