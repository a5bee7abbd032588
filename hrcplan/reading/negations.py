"""Words that turn what a sentence says, in some languages.

After a negation it says no step. A word such as "away" makes the opposite of many verbs, so it is
asked about unless it belongs to a name of the domain.
"""

from __future__ import annotations

import re

from hrcplan.reading.tokens import fold

_NEGATIONS = {
    "en": "not no never none without dont doesnt didnt isnt wont cant cannot shouldnt",
    "de": "nicht kein keine keinen keiner nie niemals ohne",
    "fr": "ne pas jamais sans aucun aucune",
    "es": "no nunca sin ningun ninguna",
    "it": "non mai senza nessun nessuna",
    "pt": "nao nunca sem nenhum nenhuma",
    "nl": "niet geen nooit zonder",
    "sv": "inte aldrig utan ikke",
    "pl": "nie nigdy bez",
}
_REVERSALS = {
    "en": "off away back rid",
    "de": "weg zuruck fort",
    "nl": "weg terug",
    "sv": "bort tillbaka",
}
_ALL = frozenset(word for words in _NEGATIONS.values() for word in words.split())
REVERSALS = frozenset(word for words in _REVERSALS.values() for word in words.split())
"""Words that may turn a verb into its opposite, folded."""
_WORD = re.compile(r"[^\W\d_]+(?:['\u2019][^\W\d_]+)*")
_INTERJECTION = re.compile(r"\W*[^\W\d_]+\s*[,;:.!]")  # "No, the nuts!" denies what was before


def denies(text: str, names: frozenset[str]) -> bool:
    """Return whether a text holds a negation that is no word of the domain's ``names``.

    >>> denies("Don't serve it", frozenset()), denies("no, serve it", frozenset())
    (True, False)
    """
    folded = fold(text)
    start = _INTERJECTION.match(folded)
    words = _WORD.findall(folded[start.end() :] if start else folded)
    plain = {word.replace("'", "").replace("\u2019", "") for word in words}
    return not (_ALL & plain) <= names
