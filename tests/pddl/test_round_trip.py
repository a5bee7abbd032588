"""What the writer writes, the reader reads as the same domain and problem."""

from dataclasses import replace
from pathlib import Path

import pytest

from hrcplan.pddl import library
from hrcplan.pddl.check import check_files, load_domain, load_problem
from hrcplan.pddl.write import domain_text, problem_text

VALID = Path(__file__).parent / "valid"
PAIRS = [
    (VALID / "courier.pddl", VALID / "courier-two-items.pddl"),
    (VALID / "liberal.pddl", VALID / "liberal-problem.pddl"),
    *(
        (library.find_domain(domain), library.find_problem(domain, problem))
        for domain in library.domain_names()
        for problem in library.problem_names(domain)
    ),
]


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair[1].stem)
def test_written_files_are_read_as_what_was_written(
    pair: tuple[Path, Path], tmp_path: Path
) -> None:
    domain = load_domain(pair[0])
    problem = load_problem(domain, pair[1])
    copies = tmp_path / "domain.pddl", tmp_path / "problem.pddl"
    copies[0].write_text(domain_text(domain))
    copies[1].write_text(problem_text(problem))
    assert check_files(copies) == ()
    again = replace(load_domain(copies[0]), path=domain.path)
    assert again == domain
    assert replace(load_problem(domain, copies[1]), path=problem.path) == problem
