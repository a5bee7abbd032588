"""Files are written completely or not at all, where the user meant them to be."""

from __future__ import annotations

from pathlib import Path

import pytest

from hrcplan.core.files import check_targets, write_atomically
from hrcplan.errors import UsageError


def test_a_link_stays_and_its_target_is_written(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_text("old")
    link.symlink_to(target)
    write_atomically(link, "new")
    assert link.is_symlink()
    assert target.read_text() == "new"


def test_a_device_stays_a_device() -> None:
    write_atomically(Path("/dev/null"), "gone")
    assert Path("/dev/null").is_char_device()


def test_nothing_is_left_where_nothing_can_be_written(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot write"):
        write_atomically(tmp_path / "no" / "folder", "text")
    (tmp_path / "a-folder").mkdir()
    with pytest.raises(UsageError, match="cannot write"):
        write_atomically(tmp_path / "a-folder", "text")
    assert [path.name for path in tmp_path.iterdir()] == ["a-folder"]


def test_two_results_need_two_files(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "plan")
    with pytest.raises(UsageError, match="another result"):
        check_targets((tmp_path / "plan", tmp_path / "." / "plan"))
    with pytest.raises(UsageError, match="another result"):
        check_targets((tmp_path / "plan", tmp_path / "link"))
    check_targets((tmp_path / "plan", tmp_path / "picture", None))
    check_targets((Path("/dev/null"), Path("/dev/null")))


def test_no_result_replaces_an_input(tmp_path: Path) -> None:
    domain, same = tmp_path / "d.pddl", tmp_path / "same"
    domain.write_text("(define …)")
    same.hardlink_to(domain)
    with pytest.raises(UsageError, match="reads it"):
        check_targets((None, same), domain)
