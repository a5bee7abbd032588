"""Words of grammar, in some languages: those that turn a sentence, and those that name nothing.

After a negation a sentence says no step. A word such as "away" makes the opposite of many verbs, so
it is asked about unless it belongs to a name of the domain. A short word that is none of grammar
("cup", "egg") may name an object.
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
_SHORT = {
    "en": "a an the my our his her its i im we me us you it he she this all any one two "
    "and or but so then now too yes ok okay oh hm um uh at by for in into of on onto out off to up "
    "m s d t ll re ve via as is am are be was has had got get let do did go can may am just",
    "de": "der die das den dem des ein ich wir du es er sie und in im ins an am auf aus bei mit "
    "von zu zum zur nun ja so da dir mir uns bin ist hab",
    "fr": "le la les un une des du de je j tu il on me m te se et ou a au aux en sur y ai as "
    "est ca ma mon mes oui puis",
    "es": "el la los las un una de del al a en y o yo tu me lo le se con por voy he ha es su mi si "
    "ya",
    "it": "il lo la i gli le l un una di del al a in e o io tu mi si con per ho ha sto si ora poi",
    "pt": "o a os as um uma de do da em no na e eu tu me se com por vou sim ja",
    "nl": "de het een ik wij je en of in op aan uit van met bij naar nu ja dan dit",
    "sv": "en ett den det jag vi du och i pa av ur om med nu ja",
    "pl": "i a w we z ze na do od po za to ja my ty o u juz tak",
}
_ALL = frozenset(word for words in _NEGATIONS.values() for word in words.split())
REVERSALS = frozenset(word for words in _REVERSALS.values() for word in words.split())
"""Words that may turn a verb into its opposite, folded."""
GRAMMAR = frozenset(word for words in _SHORT.values() for word in words.split())
"""Words of up to three letters that name nothing, folded."""
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
