"""A session at a terminal without a word of PDDL: a recipe, with a change of mind half-way."""

import re
from pathlib import Path

from tests.collaboration.test_collaborate_command import Session

SMOOTHIE = ("I grab the strawberries", "switch the blender on")
PARFAIT = (
    "tip the berries into the tumbler", "add the yoghurt to the glass",
    "pour the oats into the glass", "fetch some honey", "drizzle the honey into the glass", "",
    "put some mango in the glass", "dinner is ready",
)  # fmt: skip


def test_a_recipe_is_finished_in_own_words_with_a_change_of_mind(tmp_path: Path) -> None:
    session = Session(tmp_path, goals=("kitchen",))
    for line in (*SMOOTHIE, *PARFAIT):
        session.expect("> $")
        session.type(f"{line}\n")
    session.expect("Was that all")
    session.type("yes\n")
    assert session.wait() == 0
    assert "goal reached (parfait-fruit)" in session.text
    robot = re.findall(r"robot: ([^,\r\n]+), for ([\w-]+)", session.text)
    changed = next(n for n, (_, goal) in enumerate(robot) if goal.startswith("parfait"))
    assert changed <= len(SMOOTHIE) + 3  # it follows within three steps
    assert all(goal.startswith("parfait") for _, goal in robot[changed:])
