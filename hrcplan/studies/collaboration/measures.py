"""The measures of the study: what a collaboration costs, and those of both papers."""

from __future__ import annotations

from hrcplan.studies.measure import Measure

MEASURES = {
    "reached_pct": Measure("goals reached", "goal|reached", "%", True),
    "stuck_pct": Measure("stuck", "stuck", "%"),
    "unfinished_pct": Measure("unfinished", "unfinished", "%"),
    "team_cost": Measure("team cost", "team|cost", "metric", suffix=""),
    "makespan_s": Measure("makespan", "makespan", "s"),
    "human_cost": Measure("cost of people's attempts", "people's|cost", "cost", suffix=""),
    "questions": Measure("questions", "questions", "per episode", None),
    "failed_pct": Measure("failed actions", "failed", "% of actions", suffix="%"),
    "assigned_human_pct": Measure("attempts of people", "attempts|of people", "%", None),
    "successful_human_pct": Measure("people's share of success", "successful|human", "%", None),
    "first_correct": Measure("first right guess", "first|right guess", "actions"),
    "last_incorrect_pct": Measure("last wrong guess", "last|wrong guess", "% of episode"),
    "correct_pct": Measure("right guesses", "right|guesses", "%", True),
    "top3_pct": Measure("right goal among three", "among first|three", "%", True),
    "wasted_robot_steps": Measure("wasted robot steps", "wasted|robot steps", "per episode"),
    "detection_delay": Measure("delay of detection", "delay of|detection", "actions"),
    "false_changes": Measure("false changes", "false|changes", "per episode"),
}
DETAILS = ("n_failed", "n_actions", "n_detected")
HELP = ("reached_pct", "stuck_pct", "unfinished_pct", "team_cost", "makespan_s", "human_cost",
        "questions", "failed_pct", "wasted_robot_steps")  # fmt: skip
GUESSES = ("correct_pct", "top3_pct", "first_correct", "last_incorrect_pct", "detection_delay",
           "false_changes")  # fmt: skip
SHARES = ("assigned_human_pct", "successful_human_pct", "failed_pct", "makespan_s")
