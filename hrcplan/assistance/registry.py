"""Which assistants there are, by name; each is a class that is made from a bank."""

from typing import Any

from hrcplan.assistance.assistant import Assistant
from hrcplan.core.registry import Registry

ASSISTANTS: Registry[..., Assistant[Any]] = Registry(
    "method",
    {
        "rhp": "hrcplan.assistance.rhp.assistant:RecedingHorizonPlanner",
        "recursive": "hrcplan.assistance.field_similarity:FieldSimilarity",
        "recursive-best": "hrcplan.assistance.field_similarity:BestFieldSimilarity",
        "cdp": "hrcplan.assistance.decision_points:DecisionPoints",
        "infogain": "hrcplan.assistance.information_gain:InformationGain",
        "hrcplan": "hrcplan.assistance.expected_help:ExpectedHelp",
        "hrcplan-switching": "hrcplan.assistance.expected_help:SwitchingHelp",
        "oracle": "hrcplan.assistance.oracle:Oracle",
    },
    "hrcplan.assistants",
    Assistant,
    aliases={"paper": "rhp"},
    prefixes={"cmd": "hrcplan.assistance.command:CommandAssistant"},
    program_prefixes=frozenset({"cmd"}),
)
