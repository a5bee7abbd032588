"""The file that a journal is written to: one handle, locked as long as a run goes on."""

from __future__ import annotations

import errno
import fcntl
import os
import stat
from pathlib import Path

from hrcplan.core.files import reason_of
from hrcplan.errors import UsageError
from hrcplan.execution.journal.reader import Journal, journal_in

ROOM_HINT = "nothing before is lost: make room, then go on with --resume"


class JournalFile:
    """The file of a journal, open and locked: no other process writes it until it is closed.

    It is looked at, cut and written through one handle, and never replaced. So a link stays a link,
    and of two runs the second one is refused, whatever either of them has written so far.
    """

    def __init__(self, path: Path) -> None:
        """Open and lock a file, which is made if there is none.

        Raises:
            UsageError: if it is not an ordinary file, cannot be written, or is being written.
        """
        self.path = path
        try:
            # Without O_NONBLOCK opening a pipe without a reader would block.
            self._handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NONBLOCK, 0o666)
        except (OSError, ValueError) as error:
            raise self._refusal(error) from None
        try:
            if not stat.S_ISREG(os.fstat(self._handle).st_mode):
                raise OSError(errno.EINVAL, "it is not an ordinary file")
            fcntl.flock(self._handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self.close()
            message = "another process is writing this journal"
            raise UsageError(message, path=str(path)) from None
        except OSError as error:
            self.close()
            raise self._refusal(error) from None

    def _refusal(self, error: Exception, hint: str | None = None) -> UsageError:
        message = f"cannot write the journal: {reason_of(error)}"
        return UsageError(message, path=str(self.path), hint=hint)

    @property
    def n_bytes(self) -> int:
        """How long the file is."""
        return os.fstat(self._handle).st_size

    def journal(self) -> Journal:
        """Return what the file holds.

        Raises:
            InputError: if a line before the last is damaged, or a number is out of order.
        """
        with open(os.dup(self._handle), "rb") as file:
            file.seek(0)
            return journal_in(self.path, file.read())

    def cut(self, n_bytes: int) -> None:
        """Shorten the file; what is appended next stands behind its first ``n_bytes``."""
        os.ftruncate(self._handle, n_bytes)
        os.lseek(self._handle, n_bytes, os.SEEK_SET)

    def append(self, data: bytes) -> None:
        """Write at the end.

        Raises:
            UsageError: if there is no room left.
        """
        try:
            while data:
                data = data[os.write(self._handle, data) :]
        except OSError as error:
            raise self._refusal(error, ROOM_HINT) from None

    def sync(self) -> None:
        """Return when everything is on disk.

        Raises:
            UsageError: if there is no room left: some file systems look for it only now.
        """
        try:
            os.fsync(self._handle)
        except OSError as error:
            raise self._refusal(error, ROOM_HINT) from None

    def close(self) -> None:
        """Let other processes in."""
        os.close(self._handle)


def open_journal(path: Path | None, resume: bool) -> tuple[JournalFile | None, Journal | None]:
    """Return the file to write, and the journal in it to continue, if there are any.

    Raises:
        UsageError: if a run is to be resumed without a file, or the file cannot be written.
        InputError: if the journal is damaged.
    """
    if path is None:
        if resume:
            hint = "--journal FILE --resume"
            raise UsageError("to resume a run its journal is needed", hint=hint)
        return None, None
    file = JournalFile(path)
    if not resume or not file.n_bytes:
        return file, None
    try:
        past = file.journal()
        if past.is_empty:  # killed before the first line was complete
            file.cut(0)
            return file, None
    except BaseException:
        file.close()
        raise
    return file, past
