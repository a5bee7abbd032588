"""The measures of the study."""

from __future__ import annotations

from hrcplan.studies.measure import Measure

MEASURES = {
    "reached_pct": Measure("goals reached", "goal|reached", "%", True),
    "stuck_pct": Measure("stuck", "stuck", "%"),
    "unfinished_pct": Measure("unfinished", "unfinished", "%"),
    "unreachable_pct": Measure("goals out of reach", "out of|reach", "%"),
    "first_correct": Measure("first right guess", "first|right guess", "timesteps"),
    "last_incorrect_step": Measure("last wrong guess", "last|wrong guess", "timesteps"),
    "last_incorrect_pct": Measure("last wrong guess", "last|wrong guess", "% of episode"),
    "correct_pct": Measure("right guesses", "right|guesses", "%", True),
    "top3_pct": Measure("right goal among three", "among first|three", "%", True),
    "detection_delay": Measure("delay of detection", "delay of|detection", "timesteps"),
    "false_changes": Measure("false changes", "false|changes", "per episode"),
    "false_before": Measure(
        "false changes before the first", "before the|first true one", "per episode"
    ),
    "n_detected": Measure("changes detected", "changes|detected", "per episode", True),
    "wasted_robot_steps": Measure("wasted robot steps", "wasted|robot steps", "per episode"),
    "human_mistakes": Measure("human's mistakes", "human's|mistakes", "per episode", None),
    "robot_waits": Measure("robot's waits", "robot's|waits", "per episode", None),
    "total_steps": Measure("total steps", "total|steps", "timesteps"),
    "extra_steps": Measure("extra steps", "extra|steps", "timesteps"),
    "extra_vs_oracle": Measure("more than the oracle", "more than|the oracle", "timesteps"),
}
DECLARED = ("detection_delay", "n_detected", "false_changes", "false_before")
"""Measures of declared changes: a method that declares none has no value there."""
