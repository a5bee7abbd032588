"""Which assistants there are, by name; each is a class that is made from a bank."""

from hrcplan.parts import Parts

ASSISTANTS = Parts(
    "method",
    {
        "paper": "hrcplan.assistance.rhp:Rhp",
        "recursive": "hrcplan.assistance.recursive:Similar",
        "recursive-best": "hrcplan.assistance.recursive:SimilarBest",
        "cdp": "hrcplan.assistance.cdp:DecisionPoints",
        "infogain": "hrcplan.assistance.infogain:InformationGain",
        "hrcplan": "hrcplan.assistance.expected:Expected",
        "oracle": "hrcplan.assistance.oracle:Oracle",
    },
    "hrcplan.assistants",
)
