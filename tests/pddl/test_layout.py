"""The layout of PDDL files: words and comments stay, and a second pass changes nothing."""

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrcplan.errors import InputError, PddlError
from hrcplan.pddl.layout import WIDTH, format_text

ROOT = Path(__file__).parents[2]
TOKEN = re.compile(r";[^\r\n]*|[()]|[^\s();]+")
FOLDERS = ("domains", "problems", "tests/data")
FILES = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.pddl"))


def tokens(text: str) -> list[str]:
    return [token.rstrip() for token in TOKEN.findall(text)]


def readable(path: Path) -> bool:
    try:
        format_text(path.read_text(encoding="utf-8-sig"))
    except (PddlError, UnicodeDecodeError):
        return False
    return True


@pytest.mark.parametrize("folder", FOLDERS)
def test_files_keep_their_words_and_are_stable(folder: str) -> None:
    files = [path for path in FILES if path.is_relative_to(ROOT / folder) and readable(path)]
    assert len(files) > 2
    for path in files:
        text = path.read_text(encoding="utf-8-sig")
        layout = format_text(text)
        assert tokens(layout) == tokens(text), path
        assert format_text(layout) == layout, path


WORDS = st.sampled_from(["a", "?x", "-", "and", "b" * 70, "forall", "at", "start"])
COMMENTS = st.sampled_from(["; one\n", ";two ;\n", "\n; three\n"])
SPACES = st.sampled_from([" ", "\n", "  ", "\n\n\n", "\r\n"])


def groups(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    parts = st.lists(st.tuples(st.one_of(inner, COMMENTS), SPACES), max_size=6)
    return parts.map(lambda ps: "(" + "".join(part + space for part, space in ps) + ")")


TREES = groups(st.recursive(WORDS, groups, max_leaves=25))
HEADS = st.sampled_from([":init", ":types", ":goal", ":action a\n:effect"])
SECTIONS = st.builds("({}{}{})".format, HEADS, SPACES, TREES)


@given(st.lists(st.tuples(SECTIONS, SPACES)))
def test_any_tree_keeps_its_words_and_is_stable(sections: list[tuple[str, str]]) -> None:
    text = "(define (domain d)" + "".join(a + b for a, b in sections) + ")"
    layout = format_text(text)
    assert tokens(layout) == tokens(text)
    assert format_text(layout) == layout
    assert not re.search(r"[ \t]\n|\n\n\n|\( +[^ ;]|\r", layout)


def test_long_groups_get_a_line_for_every_part() -> None:
    facts = " ".join(f"(at start (clear b{i}))" for i in range(9))
    layout = format_text(f"(define (domain d) (:action a :parameters () :effect (and {facts})))")
    assert max(map(len, layout.splitlines())) <= WIDTH
    assert "    :effect (and\n      (at start (clear b0))\n      (at start (clear b1))\n" in layout


def test_comment_before_a_closing_parenthesis_does_not_swallow_it() -> None:
    layout = format_text("(define (domain d)\n(:predicates (p) ; last\n))")
    assert layout == "(define (domain d)\n  (:predicates\n    (p) ; last\n  ))\n".replace(
        "(p) ;", "(p)  ;"
    )


def test_text_without_matching_parentheses_is_refused() -> None:
    with pytest.raises(PddlError) as caught:
        format_text("(define (domain d)\n(:predicates (p)\n", "d.pddl")
    assert caught.value.code == "unclosed"
    assert caught.value.path == "d.pddl"


def test_text_that_is_nested_too_deeply_is_refused() -> None:
    with pytest.raises(InputError, match="150 levels"):
        format_text("(define " + "(" * 200 + ")" * 200 + ")")


def test_a_head_that_is_too_long_is_laid_out_once() -> None:
    head = "(:derived (blocked-transition ?p - process ?t - transition) (and "
    body = "(exists (?q - queue) (exists (?m - message) (exists (?n - number) (and\n(p ?q) (r ?m)"
    for n in range(30):
        once = format_text(f"(define (domain d)\n{head}{'x' * n} {body})))))))")
        assert format_text(once) == once
