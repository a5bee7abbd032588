"""Every fault is one message, and its hint says what to write instead."""

import pytest

from hrcplan.pddl.check import check_files


def faults(folder, text):
    path = folder / "domain.pddl"
    path.write_text(text)
    return check_files([path])


def errors(folder, text):
    return [fault for fault in faults(folder, text) if fault.severity == "error"]


ONE_ACTION = """(define (domain d) (:requirements :adl :numeric-fluents)
 (:predicates (p ?x) (q)) (:functions (f))
 (:action a :parameters (?x ?y) :precondition {} :effect {}))"""


@pytest.mark.parametrize(
    ("condition", "effect", "cure"),
    [
        ("(q)", "(*= (f) 2)", "scale-up"),
        ("(q)", "(inc (f) 2)", "increase"),
        ("(q)", "(delete (q))", "write (not (p))"),
        ("(xor (q) (p ?x))", "(q)", "write (or (and"),
        ("(neq ?x ?y)", "(q)", "write (not (= …))"),
        ("(gt (f) 2)", "(q)", "write >"),
        ("((f) > 3)", "(q)", "write (> A B)"),
        ("((q) and (p ?x))", "(q)", "write (and A B)"),
        ("(f > 3)", "(q)", "write (> A B)"),
        ("(?x != ?y)", "(q)", "write (not (= …))"),
        ("((q) (p ?x))", "(q)", "put the conditions in one (and …)"),
        ("(q)", "((q) (p ?x))", "put the effects in one (and …)"),
        ("(q)", "((q))", "one pair of parentheses is too much"),
        ("(not q)", "(q)", "write (q)"),
        ("(p (?x))", "(q)", "write ?x without parentheses"),
        ("(exists ?z (p ?z))", "(q)", "write (?z)"),
        ("(q)", "(when (q) (p ?x) (p ?y))", "put them in one (and …)"),
        ("(q)", "(not (q) (p ?x))", "write (and (not (p)) (not (q)))"),
    ],
)
def test_one_fault_is_one_message_with_its_cure(tmp_path, condition, effect, cure):
    found = [
        d for d in faults(tmp_path, ONE_ACTION.format(condition, effect)) if d.severity == "error"
    ]
    assert len(found) == 1
    assert cure in (found[0].hint or "")


@pytest.mark.parametrize(
    ("head", "message"),
    [
        (":vars (?z - box)", ":vars (PDDL 1.2)"),
        (":agent ?z - box", ":agent (MA-PDDL)"),
        (":agent (?z - box)", ":agent (MA-PDDL)"),
    ],
)
def test_variables_of_other_languages_are_one_fault(tmp_path, head, message):
    text = f"""(define (domain d) (:requirements :typing) (:types box)
 (:predicates (open ?b - box) (:private ?a - box (shut ?b - box)))
 (:action a {head} :parameters (?x - box) :precondition (open ?z)
  :effect (and (shut ?x) (not (open ?z)))))"""
    private, other = errors(tmp_path, text)
    assert private.message.startswith("(:private …) of MA-PDDL")
    assert other.message.startswith(message)


def test_words_of_other_languages_can_be_names(tmp_path):
    text = """(define (domain d) (:requirements :strips) (:constants + and)
 (:predicates (add ?x ?y) (neq ?x ?y) (sum ?x ?y))
 (:action a :parameters (?x) :precondition (and (neq ?x and) (sum + and)) :effect (add ?x and)))"""
    assert not faults(tmp_path, text)


@pytest.mark.parametrize("character", ["\x1b", "\u200b", "\u202e", "\x7f"])
def test_names_have_no_hidden_characters(tmp_path, character):
    text = f"""(define (domain d) ; {character} in a comment is no fault
 (:predicates (p{character}) (q))
 (:action a{character} :parameters () :precondition (q) :effect (p{character})))"""
    (fault,) = errors(tmp_path, text)
    assert (fault.line, fault.column, fault.code) == (2, 17, "not-printable")
    assert f"U+{ord(character):04X}" in fault.message
    assert not faults(tmp_path, text.replace(character, ""))


@pytest.mark.parametrize("init", ["(p) (not (p))", "(not (p)) (p)"])
def test_no_fact_is_both_true_and_false(tmp_path, init):
    domain, problem = tmp_path / "d.pddl", tmp_path / "p.pddl"
    domain.write_text("(define (domain d) (:predicates (p) (q)) (:action a :effect (q)))")
    problem.write_text(f"(define (problem b) (:domain d) (:init (not (q)) {init}) (:goal (q)))")
    (fault,) = check_files([domain, problem])
    assert (fault.severity, fault.code) == ("error", "duplicate-value")
    assert "both true and false" in fault.message


@pytest.mark.parametrize(
    ("types", "hint"),
    [
        ("b c - object a - b a - c", "write 'a - (either b c)' once"),
        ("a b a", "remove one of the two"),
        ("b - object a - b a", "write 'a - b' once"),
    ],
)
def test_a_type_that_is_listed_twice(tmp_path, types, hint):
    text = f"""(define (domain d) (:requirements :typing) (:types {types})
 (:predicates (p ?x - a)) (:action n :parameters (?x - a) :effect (p ?x)))"""
    (fault,) = faults(tmp_path, text)
    assert (fault.code, fault.hint) == ("duplicate-type", hint)


@pytest.mark.parametrize(
    ("section", "name"),
    [
        ("(:task deliver :parameters (?x)) (:task fetch :parameters (?x))", "HDDL"),
        ("(:constraint limit :condition (< (f) 3)) (:constraint low :condition (q))", "ENHSP"),
        ("(:free_functions (v))", "ENHSP"),
    ],
)
def test_sections_of_other_languages_are_named_once(tmp_path, section, name):
    text = ONE_ACTION.format("(q)", "(q)").replace("(:action", f"{section} (:action")
    found = errors(tmp_path, text)
    assert [fault.code for fault in found] == ["unsupported"]
    assert name in found[0].message


def test_an_object_that_a_domain_does_not_have(tmp_path):
    (found,) = errors(tmp_path, ONE_ACTION.format("(p wrench)", "(q)"))
    assert "(:constants …)" in found.hint


@pytest.mark.parametrize(
    ("text", "cure"),
    [
        ("(domain d)\n(:predicates (p))\n(:action a :effect (p))\n)", "a file begins with"),
        ("(domain d)\n(:predicates (p)\n(:action a :effect (p)", "a file begins with"),
        ("define (domain d) (:predicates (p)))", "write '(define'"),
        ("; a note\n(problem p) (:domain d) (:init) (:goal (p)))", "a file begins with"),
    ],
)
def test_a_missing_define_is_one_fault_whatever_its_parentheses(tmp_path, text, cure):
    (fault,) = faults(tmp_path, text)
    assert fault.code == "outside-define"
    assert cure in str(fault.hint)


def test_missing_types_are_reported_in_the_domain_and_not_again_in_its_problem(tmp_path):
    texts = {
        "d.pddl": "(define (domain d) (:requirements :typing) (:predicates (p ?x - box)))",
        "p.pddl": "(define (problem p) (:domain d) (:objects a - box) (:init) (:goal (p a)))",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    (fault,) = check_files([tmp_path / name for name in texts])
    assert (fault.code, fault.path) == ("unknown-type", str(tmp_path / "d.pddl"))


@pytest.mark.parametrize(
    ("types", "code", "cure"),
    [
        ("a - b b - c c - a", "cyclic-types", "write 'a - object' apart"),
        ("car vehicle truck - vehicel", "undeclared-supertype", "did you mean 'vehicle'?"),
        ("car truck - vehicle", "undeclared-supertype", "add 'vehicle - object'"),
        ("tool - tools", "undeclared-supertype", "add 'tools - object'"),
    ],
)
def test_a_slip_in_a_hierarchy_of_types_is_one_message(tmp_path, types, code, cure):
    (fault,) = faults(tmp_path, f"(define (domain d) (:requirements :typing) (:types {types}))")
    assert fault.code == code
    assert (fault.hint or "").startswith(cure)


def test_an_effect_called_like_a_part_of_and_is_an_effect(tmp_path):
    text = "(define (domain d) (:predicates (a)) (:action x :effect (a)))"
    assert faults(tmp_path, text) == ()


def test_a_bare_operator_is_told_to_stand_first(tmp_path):
    (fault,) = errors(tmp_path, ONE_ACTION.format("(and (p ?x) && (q))", "(q)"))
    assert fault.hint == "write and instead"


TYPED = """(define (domain d) (:requirements :strips :typing) (:types box - object)
 (:predicates (p ?x - box) (pair ?x ?y)) (:functions (weight))
 (:action a :parameters (?b - box) :precondition {} :effect (p ?b)))"""


@pytest.mark.parametrize(
    ("condition", "cure"),
    [
        ("(p b)", "did you mean '?b'?"),
        ("(p box)", "declared as ?x - box"),
        ("(p weight)", "it is a function"),
        ("(p crate-7)", "declare it in (:constants …)"),
        ("(open ?b)", "declare it in (:predicates …)"),
        ("(> (speed) 1)", "declare it in (:functions …)"),
        ("(p ?unrelated)", "list it in :parameters"),
        ("(exists (?z - lorry) (pair ?z ?z))", "declare it in (:types …)"),
        ("(exists (? z - box) (p ?b))", "without a space: ?name"),
    ],
)
def test_an_unknown_name_has_the_cure_of_its_kind(tmp_path, condition, cure):
    assert cure in (errors(tmp_path, TYPED.format(condition))[0].hint or "")


def test_an_object_of_a_problem_is_declared_in_the_problem(tmp_path):
    paths = tmp_path / "domain.pddl", tmp_path / "problem.pddl"
    paths[0].write_text(TYPED.format("(p ?b)"))
    paths[1].write_text("(define (problem x) (:domain d) (:init (p crate-7)) (:goal (pair c c)))")
    cures = [f.hint for f in check_files(paths) if f.severity == "error"]
    assert cures == ["declare it in (:objects …)"] * len(cures) != []


@pytest.mark.parametrize("mark", ["{{ robots|length }}", "{% for r in robots %}"])
def test_a_template_is_one_error_unless_it_is_a_comment(tmp_path, mark):
    (fault,) = errors(tmp_path, TYPED.format(f"(p ?b) {mark}"))
    assert fault.code == "template"
    assert "template" in fault.message
    assert not errors(tmp_path, f"; {mark}\n{TYPED.format('(p ?b)')}")


def test_private_objects_of_ma_pddl_are_named(tmp_path):
    paths = tmp_path / "domain.pddl", tmp_path / "problem.pddl"
    paths[0].write_text(TYPED.format("(p ?b)"))
    paths[1].write_text(
        "(define (problem x) (:domain d) (:objects (:private a b - box)) (:init (p a))"
        " (:goal (p b)))"
    )
    (fault,) = [f for f in check_files(paths) if f.severity == "error"]
    assert "(:private …) of MA-PDDL" in fault.message


def test_a_word_before_the_define_is_named(tmp_path):
    (fault,) = errors(tmp_path, f"lisp\n{TYPED.format('(p ?b)')}")
    assert fault.message == "'lisp' stands outside the (define …)"


def test_an_unknown_type_of_a_domain_is_no_further_fault_of_its_problem(tmp_path):
    texts = {
        "d.pddl": "(define (domain d) (:requirements :typing) (:types box)"
        " (:predicates (p ?x - boxx)))",
        "p.pddl": "(define (problem p) (:domain d) (:objects a - boxx b - box)"
        " (:init (p a) (p b)) (:goal (p a)))",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    (fault,) = check_files([tmp_path / name for name in texts])
    assert (fault.code, fault.path) == ("unknown-type", str(tmp_path / "d.pddl"))


DERIVED = """(define (domain d) (:requirements :adl :derived-predicates) (:types box)
 (:predicates (open ?b - box) (free ?b - box) (shut ?b - box)) {}
 (:action a :parameters (?b - box) :precondition (free ?b) :effect (open ?b)))"""


@pytest.mark.parametrize(
    ("axioms", "cure"),
    [
        ("(:derived (free ?b - box) (open ?b) (shut ?b))", "in one (and …)"),
        ("(:derived (and (free ?b) (shut ?b)) (open ?b))", "for each predicate"),
        ("(:derived (free left) (open left))", "(= ?x a)"),
        ("(:derived free (?b - box) (open ?b))", "then one condition"),
        ("(:derived (free ?a ?b - box) (open ?b))", "as many variables"),
        ("(:derived (free ?b) (not (shut ?b))) (:derived (shut ?b) (not (free ?b)))", "one 'not'"),
        ("(:derived (open ?b) (shut ?b))", "what it is derived from"),
    ],
)
def test_a_fault_of_a_derived_predicate_is_one_message(tmp_path, axioms, cure):
    (fault,) = faults(tmp_path, DERIVED.format(axioms))
    assert fault.severity == "error"
    assert cure in (fault.hint or "")


def test_a_derived_predicate_without_types_has_those_of_its_declaration(tmp_path):
    assert not faults(tmp_path, DERIVED.format("(:derived (free ?b) (not (open ?b)))"))
