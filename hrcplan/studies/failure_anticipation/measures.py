"""The measures of the study."""

from __future__ import annotations

from hrcplan.studies.measure import Measure

MEASURES = {
    "success_pct": Measure("success", "success", "%", True),
    "replans": Measure("replans", "replans", "per run", suffix=""),
    "failed_pct": Measure("failed", "failed", "% of actions", suffix="%"),
    "assigned_human_pct": Measure("assigned to the human", "assigned|human", "%", None),
    "assigned_robot_pct": Measure("assigned to the robot", "assigned|robot", "%", None),
    "successful_human_pct": Measure("human's successful share", "successful|human", "%", True),
    "successful_robot_pct": Measure("robot's successful share", "successful|robot", "%", None),
    "makespan_s": Measure("makespan", "makespan", "s"),
    "interactions": Measure("interactions", "interactions", "per run", None),
}
MAIN = (
    "success_pct", "replans", "failed_pct", "assigned_human_pct", "successful_human_pct",
    "makespan_s",
)  # fmt: skip
"""The measures that are reported of every case and method."""
DETAILS = ("assigned_robot_pct", "successful_robot_pct", "replans_change", "replans_failure",
           "replans_deviation", "plans_confirmed", "interactions")  # fmt: skip
