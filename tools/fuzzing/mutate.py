"""Changes of texts, bytes and JSON values, all drawn from one random generator."""

from __future__ import annotations

import copy
import math
import random
import re
from typing import Any

TOKEN = re.compile(r"\s+|;[^\n]*|[()\[\]{}=,:]|[^\s();\[\]{}=,:]+")
OPENING, BRACKETS = tuple("([{"), tuple("()[]{}")
NUMBERS = ("0", "-1", "1e999999", "9" * 5000, "0.1", "nan", "inf", "1/0", "1e-99", "2147483648")
PLAIN = (
    *("-", "?x", "and", "or", "not", "forall", "exists", "when", "either", "object", "=", "define"),
    *(":init", ":goal", ":action", ":effect", ":types", "increase", "assign", "at", "start", "all"),
    *("over", "end", "total-time", "#t", "?duration", "minimize", "domain", "problem", ":metric"),
)
WORDS = (*PLAIN, *BRACKETS, '"', "'''", "true", "1979-05-27", ";", "#", "\x1b[2J", "\u202e", "é")
VALUES: tuple[Any, ...] = (
    *(
        None,
        True,
        [],
        {},
        "",
        "x",
        0,
        -1,
        1.5,
        10**30,
        10**400,
        math.inf,
        math.nan,
        -(2**63),
        2**63,
        1e308,
        "1e999999",
        "\ud800",
    ),
    *([[]], {"x": {}}, "a" * 300, "../../../proc/self/mem", "os:getcwd", [0] * 50, "\0", "nan"),
)


def text(rng: random.Random, source: str, spice: tuple[str, ...] = WORDS + NUMBERS) -> str:
    """Return a text after a few changes of its tokens, now and then of its characters.

    Brackets are mostly left alone, and moved in pairs, so that most mutants can be tokenised.
    """
    tokens = TOKEN.findall(source)
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        if not tokens or rng.random() < 0.1:
            tokens.insert(rng.randrange(len(tokens) + 1), f" {rng.choice(spice)} ")
        else:
            _change(rng, tokens)
    found = "".join(tokens)
    return repeat(rng, found) if rng.random() < 0.02 else found


def _change(rng: random.Random, tokens: list[str]) -> None:
    words = [i for i, token in enumerate(tokens) if token.strip() and token not in BRACKETS]
    if not words:
        return
    at, other = rng.choice(words), rng.choice(words)
    match rng.randrange(7):
        case 0:
            tokens[at] = tokens[other]
        case 1:
            tokens[at], tokens[other] = tokens[other], tokens[at]
        case 2:
            del tokens[at]
        case 3:
            tokens[at] = rng.choice(NUMBERS)
        case 4:
            tokens[at] = rng.choice(PLAIN)
        case _:
            first = tokens[max(0, at - 1)]
            group = _group(tokens, at - 1) if first in OPENING else tokens[at : at + 1]
            if rng.random() < 0.5:
                tokens[other:other] = [" ", *group, " "]
            else:
                begin = at - 1 if first in OPENING else at
                del tokens[begin : begin + len(group)]


def _group(tokens: list[str], at: int) -> list[str]:
    """Return the tokens from an opening bracket to the one that closes it."""
    depth = 0
    for end in range(at, len(tokens)):
        depth += (tokens[end] in OPENING) - (tokens[end] in ")]}")
        if depth == 0:
            return tokens[at : end + 1]
    return tokens[at:]


def repeat(rng: random.Random, source: str) -> str:
    """Return a text in which a short piece stands thousands of times."""
    at = rng.randrange(len(source) + 1)
    piece = rng.choice(
        ("(", ")", " ", ";", "\n", "-", "[", "1", "a ", "(a ", "(not ", source[at : at + 9])
    )
    return source[:at] + piece * rng.choice((1000, 20_000)) + source[at:]


def data(rng: random.Random, source: bytes) -> bytes:
    """Return bytes of which some are others, missing, or there twice."""
    found = bytearray(source)
    for _ in range(rng.choice((1, 1, 2, 5))):
        at = rng.randrange(len(found) + 1)
        match rng.randrange(4):
            case 0:
                found[at : at + 1] = rng.randbytes(1)
            case 1:
                del found[at : at + rng.randrange(40)]
            case 2:
                found[at:at] = rng.randbytes(rng.randrange(20))
            case _:
                found[at:at] = found[: rng.randrange(40)]
    return bytes(found)


def value(rng: random.Random, source: Any) -> Any:
    """Return a JSON value in which one or a few entries are others, missing or added."""
    found = copy.deepcopy(source)
    for _ in range(rng.choice((1, 1, 2))):
        found = _changed(rng, found)
    return found


def _changed(rng: random.Random, found: Any) -> Any:
    is_list, is_table = isinstance(found, list), isinstance(found, dict)
    if not found or not (is_list or is_table) or rng.random() < 0.05:
        return copy.deepcopy(rng.choice(VALUES))  # it may be changed next
    key = rng.choice(list(found)) if is_table else rng.randrange(len(found))
    if isinstance(found[key], (list, dict)) and found[key] and rng.random() < 0.8:
        found[key] = _changed(rng, found[key])
    elif isinstance(found[key], str) and rng.random() < 0.3:
        found[key] = text(rng, found[key])
    elif rng.random() < 0.2:
        del found[key]
    elif is_list and rng.random() < 0.3:
        found.insert(key, copy.deepcopy(rng.choice([*VALUES, *found])))
    else:
        found[key] = copy.deepcopy(rng.choice(VALUES))
    return found
