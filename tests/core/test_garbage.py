"""The search for garbage is paused while files are read, and goes on afterwards."""

import gc

import pytest

from hrcplan.core.garbage import no_garbage_search
from hrcplan.errors import PddlError
from hrcplan.pddl.check import domain_in
from hrcplan.pddl.source import SourceText


def test_the_search_goes_on_after_an_error() -> None:
    with pytest.raises(PddlError):
        domain_in(SourceText("d.pddl", "(define (domain d) (:predicates"))
    assert gc.isenabled()


def test_a_search_that_was_off_stays_off() -> None:
    gc.disable()
    try:
        with no_garbage_search():
            assert not gc.isenabled()
        assert not gc.isenabled()
    finally:
        gc.enable()


def test_a_pause_in_a_pause_ends_with_the_outer_one() -> None:
    with no_garbage_search():
        with no_garbage_search():
            pass
        assert not gc.isenabled()
    assert gc.isenabled()
