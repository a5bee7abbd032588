"""Laws of the humans of event-driven execution."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable

from hrcplan.agents import load_profile
from hrcplan.errors import UsageError
from hrcplan.execution.journal import RunSetup, setup_from_json
from hrcplan.execution.model import ExecutionModel
from hrcplan.execution.natures import NatureSource, checked_nature
from hrcplan.execution.worlds.simulated import Nature
from hrcplan.pddl.inlining import executable
from hrcplan.pddl.model import Problem


def check_nature(
    make: Callable[[], NatureSource], problem: Problem, seeds: Iterable[str | int] = range(8)
) -> list[Nature]:
    """Test the laws of humans of event-driven execution, and return their natures, one per seed.

    The seed decides about chance: two humans with one seed behave alike, in any order of asking.
    A nature changes what the problem has, to values in range, from 0 s on. The first line of a
    journal can hold it.

    Args:
        make: The class of the human (see `hrcplan.execution.natures.NatureSource`).
        problem: The problem in which the human acts.
        seeds: The seeds to ask for.

    Raises:
        AssertionError: if a law is broken.
    """
    source, twin = make(), make()
    assert isinstance(source, NatureSource), f"{type(source).__name__} has no nature()"
    seeds, model = list(seeds), ExecutionModel(executable(problem))
    natures = [source.nature(model.problem, seed) for seed in seeds]
    for seed, nature in reversed(list(zip(seeds, natures, strict=True))):
        assert isinstance(nature, Nature), f"nature() returns a Nature, not {nature!r}"
        assert source.nature(model.problem, seed) == nature, (
            f"seed {seed!r} is answered differently"
        )
        assert twin.nature(model.problem, seed) == nature, f"two humans with seed {seed!r} differ"
        _check_content(nature, model)
    return natures


def _check_content(nature: Nature, model: ExecutionModel) -> None:
    try:
        same_nature = checked_nature(nature, model)
    except UsageError as error:
        raise AssertionError(f"the problem cannot have this nature: {error.message}") from error
    setup = RunSetup(model.problem, load_profile("hrcplan"), True, same_nature)
    try:
        line = json.loads(json.dumps(setup.to_json()))
    except (TypeError, ValueError) as error:
        raise AssertionError(f"a journal cannot hold this nature: {error}") from error
    assert setup_from_json(line, "").nature == same_nature, "a journal changes this nature"
