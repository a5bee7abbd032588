#!/usr/bin/env python3
"""Try settings of an assistant on domains made by chance, and print how well each guesses.

    tools/tune_changed_mind.py recursive --set stay=.8,.9 --set "likelihood=Needed(.01),Next(.1)"
    tools/tune_changed_mind.py hrcplan --set hazard=.05,.1 --set "mistake_rates={.05: 1},{.1: 1}"
    tools/tune_changed_mind.py hrcplan --chains --human habit inertia --set hazard=.1,.2 --by T

Goals are varied from the domain's own, which are never used themselves, so that what is chosen here
was not chosen on what it is then measured on. A setting is a keyword of the assistant or of its
belief; all combinations are tried, and every one meets the same humans. The criterion is the mean
over the humans who change their goal of the share of right guesses, or of what --by names. With
--chains the goals are not of a kitchen: jobs in chains, of which each goal needs some beginnings.
"""

import argparse
import ast
import inspect
import itertools
import random
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from hrcplan.assistance import ASSISTANTS
from hrcplan.bank import Goals, build, from_problems, read_goals
from hrcplan.bank.variants import vary
from hrcplan.episodes.episode import play
from hrcplan.episodes.humans import HUMANS, Course
from hrcplan.episodes.measures import guesses, n_wasted
from hrcplan.errors import HrcplanError
from hrcplan.inference.recursive import Attractor, Needed, Next
from hrcplan.inference.registry import METHODS
from hrcplan.pddl.check import domain_in, problem_in
from hrcplan.pddl.source import SourceText

BELIEFS = {"recursive": "recursive", "hrcplan": "adaptive", "cdp": "forest", "infogain": "forest"}
LIKELIHOODS = {kind.__name__: kind for kind in (Needed, Attractor, Next)}
JOBS = """
(define (domain jobs) (:requirements :strips :typing) (:types agent job - object)
  (:predicates (controllable ?a - agent) (after ?j ?k - job) (done ?j - job))
  (:action do :parameters (?a - agent ?j ?k - job)
    :precondition (and (after ?j ?k) (done ?j)) :effect (done ?k)))
"""
JOBS_PROBLEM = """
(define (problem g{n}) (:domain jobs) (:objects ann robo - agent begin {jobs} - job)
  (:init (controllable robo) (done begin) {after}) (:goal (and {goal})))
"""
HUMAN_KINDS = ("fixed", "optimal", "suboptimal")
MEASURES = ("first", "last%", "correct%", "waste", "T")
BEST = "correct%"  # more of it is better, of all others less


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("assistant", help="name or module:Class")
    parser.add_argument("--belief", help="name or module:Class; its own by default")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE,…", dest="grid")
    parser.add_argument("--domain", default="kitchen", help="path or shipped name")
    parser.add_argument("--goals", type=int, default=30, help="goals of each bank")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3], help="one bank each")
    parser.add_argument("--episodes", type=int, default=60, help="per bank and human")
    parser.add_argument("--mistake-rate", type=float, default=0.1, help="of the suboptimal human")
    parser.add_argument(
        "--human", default=["frontier"], nargs="+", help="how humans choose steps; several, or all"
    )
    parser.add_argument("--chains", action="store_true", help="goals of jobs in chains")
    parser.add_argument("--by", choices=MEASURES, default=BEST, help="what is to be good")
    args = parser.parse_args()
    try:
        settings = combinations(args.grid)
        scores = tried(args, settings)
    except HrcplanError as error:
        print(f"error: {error}", file=sys.stderr)
        return error.exit_code
    show(settings, scores, args)
    return 0


def combinations(grid: list[str]) -> list[dict[str, object]]:
    """Return all settings; values are Python literals or likelihoods of recursive Bayes."""
    keys, values = [], []
    for text in grid:
        key, _, rest = text.partition("=")
        keys.append(key)
        values.append([_value(node) for node in ast.parse(f"[{rest}]", mode="eval").body.elts])
    return [dict(zip(keys, chosen, strict=True)) for chosen in itertools.product(*values)]


def _value(node: ast.expr) -> object:
    if isinstance(node, ast.Call):
        return LIKELIHOODS[node.func.id](*map(_value, node.args))
    return ast.literal_eval(node)


def tried(args: argparse.Namespace, settings: list[dict[str, object]]) -> np.ndarray:
    """Return the measures of every episode: [setting, human, episode, measure]."""
    people = [(HUMANS.find(name), kind) for name in args.human for kind in HUMAN_KINDS]
    found: list[list[list[tuple[float, ...]]]] = [[[] for _ in people] for _ in settings]
    for seed in args.seeds:
        bank = build(
            chains(args.goals, seed)
            if args.chains
            else vary(read_goals(args.domain), args.goals, seed)
        )
        plans = {kind: courses(bank, kind, args, seed) for kind in HUMAN_KINDS}
        known: dict[str, object] = {}  # beliefs; a forest is trained once
        for i, setting in enumerate(settings):
            robot = made(bank, args, setting, known)
            began = time.monotonic()
            for j, (human, kind) in enumerate(people):
                found[i][j] += [measured(bank, human, robot, course) for course in plans[kind]]
            took = (time.monotonic() - began) / (len(people) * args.episodes)
            print(f"bank {seed}: {setting} {1e3 * took:.1f} ms an episode", file=sys.stderr)
    return np.array(found)


def chains(n: int, seed: int, n_chains: int = 14, length: int = 5) -> Goals:
    """Return goals that need the beginnings of four to six chains of jobs, some of them popular."""
    rng = random.Random(seed)
    jobs = [f"j{chain}-{i}" for chain in range(n_chains) for i in range(length)]
    before = ["begin" if i % length == 0 else jobs[i - 1] for i in range(len(jobs))]
    after = [f"(after {first} {then})" for first, then in zip(before, jobs, strict=True)]
    popular = [1 / (1 + 0.35 * chain) for chain in range(n_chains)]
    wanted: dict[tuple[str, ...], None] = {}
    while len(wanted) < n:
        n_needed, needed = rng.randint(4, 6), list[int]()
        while len(needed) < n_needed:
            chain = rng.choices(range(n_chains), popular)[0]
            needed += [] if chain in needed else [chain]
        last = sorted((chain, rng.randint(2, length)) for chain in needed)
        wanted[tuple(f"(done j{chain}-{steps - 1})" for chain, steps in last)] = None
    domain = domain_in(SourceText("jobs", JOBS))
    words = {"jobs": " ".join(jobs), "after": " ".join(after)}
    texts = [
        JOBS_PROBLEM.format(n=i, goal=" ".join(facts), **words) for i, facts in enumerate(wanted)
    ]
    return from_problems([problem_in(domain, SourceText(f"g{i}", t)) for i, t in enumerate(texts)])


def made(bank, args: argparse.Namespace, setting: dict[str, object], known: dict[str, object]):
    """Return an assistant with its belief, each with the keywords that it knows."""
    kind = ASSISTANTS.find(args.assistant)
    belief = METHODS.find(args.belief or BELIEFS.get(args.assistant, "switching"))
    theirs = inspect.signature(belief).parameters
    own = {key: value for key, value in setting.items() if key not in theirs}
    unknown = set(own) - set(inspect.signature(kind).parameters)
    if unknown:
        raise SystemExit(f"neither {args.assistant} nor its belief has '{min(unknown)}'")
    rest = {key: value for key, value in setting.items() if key in theirs}
    if str(rest) not in known:
        known[str(rest)] = belief(bank, **rest)
    return kind(bank, belief=known[str(rest)], **own)


def courses(bank, kind: str, args: argparse.Namespace, seed: int) -> list[Course]:
    """Return what the humans of one bank want; a change comes before the first goal is reached."""
    rng = random.Random(f"{seed}/{kind}")
    rate = args.mistake_rate if kind == "suboptimal" else 0.0
    found = []
    for i in range(args.episodes):
        first, second = rng.sample(range(len(bank.names)), 2)
        at = rng.randint(1, max(1, (bank.graphs[first].n_steps - 1) // 2))
        goals, turns = ((first,), ()) if kind == "fixed" else ((first, second), (at,))
        found.append(Course(goals, turns, rate, seed=f"{seed}/{i}"))
    return found


def measured(bank, human, robot, course: Course) -> tuple[float, ...]:
    record = play(bank, human(bank, course), robot, course)
    g = guesses(record)
    first = record.n_turns if g.first_correct is None else g.first_correct
    return first, g.last_incorrect_pct, g.correct_pct, n_wasted(record), record.cost


def show(settings: list[dict[str, object]], scores: np.ndarray, args: argparse.Namespace) -> None:
    by, people = args.by, list(itertools.product(args.human, HUMAN_KINDS))
    changing = [i for i, (_, kind) in enumerate(people) if kind != "fixed"]
    score = scores[:, changing][..., MEASURES.index(by)].mean(axis=1)
    sign = -1 if by == BEST else 1
    order = np.argsort(sign * score.mean(axis=1), kind="stable")
    best, n = order[0], score.shape[1]
    print(f"{n} episodes per human, the same for every setting; score: {by}, mean over the humans")
    print("who change; behind: the best, with the standard error of the paired difference;")
    print("humans: " + ", ".join(" ".join(person) for person in people))
    print(f"score  behind       | {' / '.join(MEASURES)} of each human | setting")
    for i in order:
        gap = sign * (score[i] - score[best])
        error = gap.std(ddof=1) / np.sqrt(n) if n > 1 else 0.0
        means = scores[i].mean(axis=1)
        cells = " | ".join(" / ".join(f"{value:.2f}" for value in row) for row in means)
        words = ", ".join(f"{key}={value}" for key, value in settings[i].items())
        print(f"{score[i].mean():.2f}  {gap.mean():.2f} ± {error:.2f}  | {cells} | {words}")


if __name__ == "__main__":
    sys.exit(main())
