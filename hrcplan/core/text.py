"""Text for messages: quoted, cut, counted, and the nearest known name."""

from __future__ import annotations

from collections.abc import Iterable

MAX_QUOTE = 60  # characters of a file that a message repeats at a time
_LAYOUT = "\n\t\N{NO-BREAK SPACE}"  # `str.isprintable` is False of them, and yet they are harmless


def quote(text: str) -> str:
    r"""Return ``text`` in quotes, shortened, and harmless to a terminal.

    >>> quote("wp1"), quote("a\x1b[31m")
    ("'wp1'", "'a\\x1b[31m'")
    """
    snippet = cut(text, MAX_QUOTE)
    return f"'{snippet}'" if snippet.isprintable() else f"'{ascii(snippet)[1:-1]}'"


def harmless(text: str) -> str:
    r"""Return ``text`` with everything that could steer a terminal as its escape.

    That is every character that is not printable: control characters, marks that reverse the
    direction of writing, and single surrogates. Ends of lines and tabs stay.

    >>> harmless("wp1\x1b[2J\u202e\n")
    'wp1\\x1b[2J\\u202e\n'
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c in _LAYOUT else ascii(c)[1:-1] for c in text)


def plural(n: int, word: str) -> str:
    """Return ``n`` and the word, with an ``s`` unless there is one.

    >>> plural(1, "part"), plural(2, "part")
    ('1 part', '2 parts')
    """
    return f"{n} {word}" if n == 1 else f"{n} {word}s"


def cut(text: str, limit: int) -> str:
    """Return the text, shortened to ``limit`` characters."""
    return text if len(text) <= limit else f"{text[: limit - 1]}…"


def nearest_name(word: str, names: Iterable[str], similarity: float = 0.6) -> str | None:
    """Return the known name that is most like ``word``, or None if none is close."""
    from rapidfuzz import distance, process

    match = process.extractOne(
        word[:MAX_QUOTE],
        [name for name in names if name != word],
        scorer=distance.OSA.normalized_similarity,
        score_cutoff=similarity,
    )
    return None if match is None else str(match[0])


def nearest(word: str, names: Iterable[str]) -> str | None:
    """Return a "did you mean" hint for ``word``, or None if nothing known is close.

    >>> nearest("motivaton", ["motivation", "capacity"])
    "did you mean 'motivation'?"
    """
    name = nearest_name(word, names)
    return None if name is None else f"did you mean {quote(name)}?"


def type_text(value: object) -> str:
    """Return the name of a value's type, for a message about a wrong argument.

    >>> type_text(3), type_text([]), type_text(None)
    ('int', 'list', 'None')
    """
    return "None" if value is None else type(value).__name__
