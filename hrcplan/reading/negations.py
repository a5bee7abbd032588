"""Words by which a sentence denies something, in some languages: it then says no step."""

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
_ALL = frozenset(word for words in _NEGATIONS.values() for word in words.split())
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
