"""Robots that are programs: they are asked in JSON lines, and what they answer is checked."""

import shlex
import sys
from pathlib import Path

import pytest

from hrcplan.assistance import ASSISTANTS
from hrcplan.assistance.command import CommandAssistant
from hrcplan.bank import Bank
from hrcplan.episodes.episode import REACHED, play
from hrcplan.episodes.humans import HUMANS, Course
from hrcplan.errors import HrcplanError, LimitError, UsageError
from hrcplan.testing import check_assistant

COUNTER = """
import json, sys
for line in sys.stdin:
    message = json.loads(line)
    if message["kind"] == "task":
        assert all(f"(problem {goal})" in message["problems"][goal] for goal in message["goals"])
        n = len(message["goals"])
        continue
    seen = sum(entry["agent"] != "robo" for entry in message["history"])
    options = message["options"]
    answer = {"posterior": [float(i == seen % n) for i in range(n)], "declared": seen // 2,
              "action": options[seen % len(options)] if options else None}
    print(json.dumps(answer), flush=True)
"""


def robot(bank: Bank, folder: Path, program: str) -> CommandAssistant:
    (folder / "robot.py").write_text(program)
    words = shlex.join([sys.executable, str(folder / "robot.py")])
    part = ASSISTANTS.make(f"cmd:{words}", bank)
    assert isinstance(part, CommandAssistant)
    return part


def test_a_program_is_an_assistant(workshop: Bank, tmp_path: Path) -> None:
    plans = [next(workshop.plans(goal)) for goal in range(2)]
    check_assistant(robot(workshop, tmp_path, COUNTER), workshop, plans)


def test_an_episode_with_a_program(workshop: Bank, tmp_path: Path) -> None:
    course = Course((0, 1), (1,), seed="x")
    human = HUMANS.make("frontier", workshop, course)
    record = play(workshop, human, robot(workshop, tmp_path, COUNTER), course)
    assert record.ending == REACHED
    guesses = [turn.guess for turn in record.turns if turn.guess is not None]
    assert guesses == [(i + 1) % len(workshop.names) for i in range(len(guesses))]
    assert record.turns[-1].n_declared in (0, len(guesses) // 2)


def asks(line: str) -> str:
    return f"import sys\nsys.stdin.readline(); sys.stdin.readline()\n{line}"


BAD = {
    "no JSON": ("print('yes')", "answers yes"),
    "too few goals": ('print(\'{"posterior": [1], "action": null}\')', "one probability for each"),
    "no option": (
        'print(\'{"posterior": [1, 0, 0, 0, 0], "action": "(fly robo)"}\')',
        r"'\(fly robo\)' is none of the options",
    ),
    "no action": ("print('{\"posterior\": [1, 0, 0, 0, 0]}')", "KeyError: 'action'"),
    "it ends": ("sys.exit('no idea')", r"it ended \(exit code 1: no idea\)"),
}


@pytest.mark.parametrize("kind", BAD)
def test_a_bad_answer_is_an_error_in_words(workshop: Bank, tmp_path: Path, kind: str) -> None:
    program, message = BAD[kind]
    part = robot(workshop, tmp_path, asks(program))
    with pytest.raises(HrcplanError, match=message) as caught:
        part.posterior(part.start())
    assert caught.value.exit_code == 5


def test_a_program_that_does_not_answer(
    workshop: Bank, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hrcplan.assistance.command.ANSWER_S", 0.2)
    part = robot(workshop, tmp_path, asks("import time; time.sleep(60)"))
    with pytest.raises(LimitError, match="has not answered"):
        part.choose(part.start())


def test_a_command_that_is_none(workshop: Bank) -> None:
    with pytest.raises(UsageError, match="needs a program"):
        ASSISTANTS.make("cmd: ", workshop)
    part = ASSISTANTS.make("cmd:no-such-program-here", workshop)
    with pytest.raises(HrcplanError, match="there is no program 'no-such-program-here'"):
        part.choose(part.start())


def test_a_file_cannot_name_a_program() -> None:
    with pytest.raises(UsageError, match="a file cannot name the method"):
        ASSISTANTS.find_listed("cmd:python3 robot.py")
