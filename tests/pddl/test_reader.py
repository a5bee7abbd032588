"""Text to tree: places, disguises that change nothing, and repairs of parentheses."""

import time
from dataclasses import fields
from pathlib import Path

import pytest

from hrcplan.core.text import nearest
from hrcplan.pddl.check import check_files, load_domain, load_problem
from hrcplan.pddl.model import Domain, Problem
from hrcplan.pddl.reader import (
    MAX_DEPTH,
    FlatNode,
    GroupNode,
    ParseNode,
    WordNode,
    read,
    read_nodes,
)
from hrcplan.pddl.source import MAX_FAULTS, SourceText, decode

VALID = Path(__file__).parent / "valid"
PAIRS = [
    (VALID / "courier.pddl", VALID / "courier-two-items.pddl"),
    (VALID / "liberal.pddl", VALID / "liberal-problem.pddl"),
]


def upper(text: str) -> str:
    """The text in capitals, but for comments, whose ``hrcplan:`` notes are in any case too."""
    return text.upper()


def commented(text: str) -> str:
    return text.replace("\n", " ; ( a :comment ) ;; (\n") + ";no newline at the end ("


DISGUISES = {
    "upper case": lambda text: upper(text).encode(),
    "CRLF": lambda text: text.replace("\n", "\r\n").encode(),
    "CR": lambda text: text.replace("\n", "\r").encode(),
    "byte order mark": lambda text: b"\xef\xbb\xbf" + text.encode(),
    "comments": lambda text: commented(text).encode(),
    "tabs": lambda text: text.replace("  ", "\t").encode(),
    "loose": lambda text: text.replace("(", " (\n\t").replace(")", "\n )\f ").encode(),
    "flat": lambda text: "\n".join(line.strip() for line in text.splitlines()).encode(),
}


def load(domain: Path, problem: Path) -> tuple[Domain, Problem]:
    loaded = load_domain(domain)
    return loaded, load_problem(loaded, problem)


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair[0].stem)
@pytest.mark.parametrize("disguise", DISGUISES)
def test_a_disguise_changes_nothing(disguise: str, pair: tuple[Path, Path], tmp_path: Path) -> None:
    copies = []
    for path in pair:
        copies.append(tmp_path / path.name)
        copies[-1].write_bytes(DISGUISES[disguise](path.read_text(encoding="utf-8")))
    assert check_files(copies) == ()
    plain, hidden = load(*pair), load(*copies)
    for one, other in zip(plain, hidden, strict=True):
        names = [field.name for field in fields(one)]
        differences = {n for n in names if getattr(one, n) != getattr(other, n)}
        assert differences <= {"path", "domain"}


def test_words_are_lower_case_and_know_their_place() -> None:
    source = SourceText("x", "; comment (\n(define (Domain A))")
    root = read(source)
    assert root == ["define", ["domain", "a"]]
    assert isinstance(root, GroupNode)
    inner = root[1]
    assert isinstance(inner, GroupNode)
    word = inner[1]
    assert isinstance(word, WordNode)
    places = [source.position(node.at) for node in (root, inner, word)]
    assert places == [(2, 1), (2, 9), (2, 17)]


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_lines_end_in_three_ways(newline: str) -> None:
    source = decode("x", newline.join(["ab", "", "cd"]).encode())
    assert source.position(source.text.index("d")) == (3, 2)


def test_columns_count_characters_not_bytes() -> None:
    source = decode("x", "é∀ x".encode())
    assert source.position(source.text.index("x")) == (1, 4)


def repaired(text: str) -> tuple[object, list[tuple[int, int, str]]]:
    source = SourceText("x", text)
    root = read(source)
    return root, [(d.line, d.column, d.code) for d in source.diagnostics]


def test_a_group_inside_a_full_one_shows_where_the_parenthesis_is_missing() -> None:
    text = "(define (problem p) (:init (at a b (= (f a) 1) (q)) (:goal (and)))"
    root, faults = repaired(text)
    assert root == read(SourceText("x", text.replace("(at a b (", "(at a b) (")))
    assert faults == [(1, 28, "unclosed")]


def test_the_layout_decides_where_the_content_does_not() -> None:
    text = (
        "(define (domain d)\n  (:action a\n    :precondition (and\n      (or (p)\n        (q)\n"
        "      (r))\n    :effect (p)))"
    )
    root, faults = repaired(text)
    assert root == read(SourceText("x", text.replace("(q)", "(q))")))
    assert faults == [(4, 7, "unclosed")]


def test_no_layout_changes_the_reading_of_a_file_without_faults() -> None:
    text = "(define (domain d)\n(:action a\n:precondition (and\n(or\n(p)\n)\n(r))\n:effect (p)))"
    root, faults = repaired(text)
    assert root == read(SourceText("x", " ".join(text.split())))
    assert faults == []


@pytest.mark.parametrize("removed", range(40))
def test_any_one_missing_parenthesis_is_one_fault_of_its_section(removed: int) -> None:
    text = (VALID / "courier.pddl").read_text(encoding="utf-8")
    at = [i for i, c in enumerate(text) if c == ")"][removed]
    source = SourceText("x", text[:at] + text[at + 1 :])
    read(source)
    (fault,) = source.diagnostics
    assert fault.code == "unclosed"
    section = text.rfind("\n  (:", 0, at)
    first = 1 if section < 0 else source.position(section + 1)[0]
    assert first <= fault.line <= source.position(at)[0]


@pytest.mark.parametrize("added", range(40))
def test_any_one_parenthesis_too_many_is_one_fault_near_it(added: int) -> None:
    text = (VALID / "courier.pddl").read_text(encoding="utf-8")
    at = [i for i, c in enumerate(text) if c == ")"][added]
    source = SourceText("x", text[:at] + ")" + text[at:])
    read(source)
    (fault,) = source.diagnostics
    assert fault.code == "stray-parenthesis"
    section = text.find("\n  (:", at)
    assert source.position(at)[0] <= fault.line <= source.position(section)[0] or section < 0


def test_groups_at_the_deepest_level_are_read_and_deeper_ones_left_out() -> None:
    deepest = "(" * MAX_DEPTH + ")" * MAX_DEPTH
    assert repaired(f"(define{deepest[1:-1]})")[1] == []
    assert repaired(f"(define{deepest})")[1] == [(1, 7 + MAX_DEPTH, "too-deep")]


def test_a_formula_at_the_deepest_level_can_be_used() -> None:
    inner = MAX_DEPTH - 3
    deep = "(not " * inner + "(p)" + ")" * inner
    text = f"(define (domain d) (:predicates (p)) (:action a :precondition {deep} :effect (p)))"
    from hrcplan.pddl.domain import read_domain

    source = SourceText("x", text)
    root = read(source)
    assert root is not None
    action = read_domain(root, source).actions[0]
    assert source.diagnostics == []
    assert str(action.conditions[0].formula).count("not") == inner
    assert hash(action) == hash(action)
    assert repr(action)


def test_a_file_of_nonsense_gives_a_limited_number_of_faults_quickly() -> None:
    source = SourceText("x", "(define (domain d) " + "(x) " * 50_000 + ")")
    root = read(source)
    assert root is not None
    from hrcplan.pddl.domain import read_domain

    started = time.process_time()
    read_domain(root, source)
    assert time.process_time() - started < 20
    assert len(source.diagnostics) == MAX_FAULTS
    assert source.diagnostics[-1].code == "too-many"


def test_a_hint_names_what_is_close_and_nothing_else() -> None:
    assert nearest("graps", ["grasp", "place"]) == "did you mean 'grasp'?"
    assert nearest("zzz", ["grasp", "place"]) is None


@pytest.mark.parametrize(
    "text",
    [
        "(a b)", "( a  ?b\t-c )", "(a (b c) d)", "(a ?b?c)", "(?a b)", "(:a b)", "(a :b)",
        "(a ; c\n b)", "(a b", "a b)", "((a) (b))", "()", "(a)(b)", "(é É x)",
    ],
)  # fmt: skip
def test_groups_of_words_have_the_places_that_they_have_in_the_text(text: str) -> None:
    """Such a group is read as one token: its words stand where they stand all the same."""

    def check(node: ParseNode) -> None:
        if isinstance(node, GroupNode):
            assert text[node.at] == "("
            for part in node:
                check(part)
        else:
            assert text[node.at : node.at + len(node)].lower() == node

    for node in read_nodes(SourceText("x", text)):
        check(node)


def test_facts_of_an_initial_state_know_their_words_and_places() -> None:
    text = "(define (problem p) (:domain d) (:init\n (at  bob home) (not (at a b)) (q)))"
    root = read(SourceText("x", text))
    assert root is not None
    init = root[3]
    assert isinstance(init, GroupNode)
    facts = [node for node in init if isinstance(node, FlatNode)]
    assert [fact.words() for fact in facts] == [["at", "bob", "home"], ["q"]]
    (group, *_) = facts
    assert group == ["at", "bob", "home"]
    assert [text[word.at :].split()[0] for word in group] == ["at", "bob", "home)"]


def test_a_fault_in_one_fact_of_many_stands_at_its_word(tmp_path: Path) -> None:
    names = {"d.pddl": "(define (domain d) (:predicates (p ?x ?y)))"}
    names["p.pddl"] = (
        "(define (problem p) (:domain d) (:objects a b)\n(:init (p a b)\n(p a  c)\n(p b))"
        "\n(:goal (p b a)))"
    )
    for name, text in names.items():
        (tmp_path / name).write_text(text)
    found = check_files([tmp_path / name for name in names])
    assert [(d.line, d.column, d.code) for d in found if d.severity == "error"] == [
        (3, 7, "unknown-object"),
        (4, 1, "wrong-arity"),
    ]


def test_a_group_of_words_is_a_list_whatever_is_asked_first() -> None:
    """Its words are made when the first method of lists is called, whichever that is."""

    def node(text: str = "(p ?x  b)") -> GroupNode:
        (group,) = read_nodes(SourceText("x", text))
        assert isinstance(group, FlatNode)
        return group

    plain = ["p", "?x", "b"]
    answers = [
        (node() == plain, True), (plain == node(), True), (node() == node(), True),
        (node() != ["p"], True), (node() < ["q"], True), ([node()] == [plain], True),
        (len(node()), 3), (bool(node()), True), (list(node()), plain), ([*node()], plain),
        (node()[1:], ["?x", "b"]), (node().index(WordNode("b")), 2), ("b" in node(), True),
        (repr(node()), repr(plain)), (node() + node(), plain + plain), (node().head, "p"),
        (next(reversed(node())), "b"), (node().count(WordNode("p")), 1),
    ]  # fmt: skip
    for number, (answer, right) in enumerate(answers):
        assert answer == right, number
    longer = node()
    longer.append(longer[0])
    assert longer == [*plain, "p"]
    assert not isinstance(longer, FlatNode)
