"""The file of a journal: links and devices stay what they are, and no two runs write one file."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

import pytest

from hrcplan.errors import UsageError
from hrcplan.execution.execute import execute
from hrcplan.execution.journal import JournalFile, read_journal

TASK = ("transport", "two-boxes")


@pytest.mark.parametrize("resume", [False, True])
def test_a_pipe_is_refused_and_stays(tmp_path: Path, resume: bool) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(UsageError, match="cannot write the journal: it is not an ordinary file"):
        execute(*TASK, journal=pipe, resume=resume)
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_disk_that_is_full_when_it_is_synced_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fsync(handle: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", fsync)
    with pytest.raises(UsageError, match="cannot write the journal: No space left") as error:
        execute(*TASK, journal=tmp_path / "journal")
    assert "--resume" in (error.value.hint or "")
    monkeypatch.undo()
    assert execute(*TASK, journal=tmp_path / "journal", resume=True).outcome.success


@pytest.mark.parametrize("resume", [False, True])
@pytest.mark.parametrize("before", [b"", b'{"seq":0,"jour'], ids=["empty", "torn"])
def test_a_link_stays_a_link(tmp_path: Path, resume: bool, before: bytes) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_bytes(before)
    link.symlink_to("target")
    if before and not resume:
        with pytest.raises(UsageError, match="exists already"):
            execute(*TASK, journal=link, resume=resume)
        assert target.read_bytes() == before
        return
    execute(*TASK, journal=link, resume=resume)
    assert link.is_symlink()
    assert "row" in read_journal(target).lines[-1]


@pytest.mark.parametrize("resume", [False, True])
@pytest.mark.parametrize("before", [b"", b'{"seq":0,"jour'], ids=["empty", "torn"])
def test_a_journal_that_is_being_written_is_left_alone(
    tmp_path: Path, resume: bool, before: bytes
) -> None:
    path = tmp_path / "journal"
    path.write_bytes(before)
    other = JournalFile(path)
    inode = path.stat().st_ino
    with pytest.raises(UsageError, match="another process is writing"):
        execute(*TASK, journal=path, resume=resume)
    assert (path.read_bytes(), path.stat().st_ino) == (before, inode)
    other.close()
    if resume or not before:
        assert execute(*TASK, journal=path, resume=resume).outcome.success
        assert path.stat().st_ino == inode


def test_a_run_that_ends_while_another_begins_is_not_overwritten(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Between looking and writing there is no moment at which another run's journal is lost."""
    path = tmp_path / "journal"
    real = os.open

    def late(name: object, *rest: object, **more: object) -> int:
        if name == path and not path.exists():
            monkeypatch.undo()
            execute(*TASK, journal=path)
        return real(name, *rest, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(os, "open", late)
    with pytest.raises(UsageError, match="exists already"):
        execute(*TASK, journal=path)
    assert "row" in read_journal(path).lines[-1]


def test_nesting_in_a_journal_is_a_damaged_line(tmp_path: Path) -> None:
    path = tmp_path / "journal"
    path.write_text("[" * 100_000 + "\n")
    from hrcplan.errors import InputError

    with pytest.raises(InputError, match="it is damaged"):
        read_journal(path)
