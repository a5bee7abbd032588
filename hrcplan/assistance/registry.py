"""Which assistants there are, by name; each is a class that is made from a bank."""

from hrcplan.core.registry import Registry

ASSISTANTS = Registry(
    "method",
    {
        "paper": "hrcplan.assistance.rhp.assistant:RecedingHorizonPlanner",
        "recursive": "hrcplan.assistance.field_similarity:FieldSimilarity",
        "recursive-best": "hrcplan.assistance.field_similarity:BestFieldSimilarity",
        "cdp": "hrcplan.assistance.decision_points:DecisionPoints",
        "infogain": "hrcplan.assistance.information_gain:InformationGain",
        "hrcplan": "hrcplan.assistance.expected_help:ExpectedHelp",
        "oracle": "hrcplan.assistance.oracle:Oracle",
    },
    "hrcplan.assistants",
)
