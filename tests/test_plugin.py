"""The pytest plugin, as a stranger's project uses it."""

from __future__ import annotations

import pytest

from hrcplan.pddl import library

pytest_plugins = ["pytester"]


@pytest.fixture
def project(pytester: pytest.Pytester) -> pytest.Pytester:
    """A project with a domain of its own and a problem beside it, apart from this checkout."""
    folder = pytester.mkdir("problems")
    domain = (library.root() / "domains" / "transport.pddl").read_text(encoding="utf-8")
    problem = (library.root() / "problems" / "transport" / "two-boxes.pddl").read_text("utf-8")
    (folder / "domain.pddl").write_text(domain.replace("(domain transport)", "(domain depot)"))
    (folder / "easy.pddl").write_text(problem.replace("(:domain transport)", "(:domain depot)"))
    return pytester


def run(project: pytest.Pytester, *words: str) -> pytest.RunResult:
    return project.runpytest_subprocess("-p", "no:cacheprovider", "-v", *words)


def test_problem_files_are_test_cases(project: pytest.Pytester) -> None:
    result = run(project)
    result.assert_outcomes(passed=3)
    result.stdout.fnmatch_lines(["*easy.pddl::check PASSED*", "*easy.pddl::plan PASSED*"])


def test_a_faulty_problem_fails_with_its_place(project: pytest.Pytester) -> None:
    path = project.path / "problems" / "easy.pddl"
    path.write_text(path.read_text().replace("(box-at green wp2)", "(box-at grean wp2)"))
    result = run(project)
    result.assert_outcomes(passed=1, failed=2)
    result.stdout.fnmatch_lines(["*easy.pddl:*unknown-object*did you mean 'green'?*"])


def test_an_unsolvable_problem_fails(project: pytest.Pytester) -> None:
    path = project.path / "problems" / "easy.pddl"
    path.write_text(path.read_text().replace("(free robot)", "").replace("(free human)", ""))
    result = run(project)
    result.assert_outcomes(passed=2, failed=1)
    result.stdout.fnmatch_lines(["*unsolvable after*"])


def test_collection_can_be_turned_off(project: pytest.Pytester) -> None:
    project.makeini("[pytest]\nhrcplan = false")
    run(project).assert_outcomes()


def test_plans_in_tests(project: pytest.Pytester) -> None:
    project.makepyfile(
        """
        import pytest
        from hrcplan.pytest_plugin import assert_valid_plan

        def test_good(hrcplan_plan):
            found = hrcplan_plan("problems/domain.pddl", "problems/easy.pddl", planner="kairos")
            assert_valid_plan("problems/domain.pddl", "problems/easy.pddl", str(found.plan))

        def test_bad():
            with pytest.raises(AssertionError, match="step 1: .*needs"):
                assert_valid_plan("problems/domain.pddl", "problems/easy.pddl",
                                  "(grasp human blue wp4)")
        """
    )
    run(project, "test_plans_in_tests.py").assert_outcomes(passed=2)
