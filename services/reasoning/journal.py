"""What was learned, on disk: a journal of changes that several processes share.

One file, `knowledge.journal`. A line is the CRC-32 of a record and the record, a
`Change` as JSON. A change is appended and synced before it counts. What a crash
can leave is one incomplete line at the end; it never counted, and the next
writer drops it by writing the file anew. A file is written anew beside its
name, synced and renamed, so that there is always a whole one.

A file therefore only grows, or is another file: (inode, size) tells whether
there is something new, for the price of one `stat`. The file is kept open, so
that its inode cannot be given to another.
"""

from __future__ import annotations

import contextlib
import fcntl
import logging
import os
import tempfile
import time
import zlib
from collections.abc import Iterator
from pathlib import Path

from pydantic import ValidationError

from services.reasoning.change import Change
from shared.errors import InternalError, NotStored, StageUnavailable, TooBusy

_SETTING = "SPARGE_REASONING_KNOWLEDGE_DIR"
_HEADER = b"sparge knowledge 1\n"
_WAIT_S = 5.0

log = logging.getLogger("sparge")


class Journal:
    """The journal in a folder; not safe across threads, but across processes.

    Parameters
    ----------
    folder : Path
        Need not exist until the first change is stored.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._file = folder / "knowledge.journal"
        self._handle: int | None = None
        self._seen = 0
        """The size of the file when it was last read."""
        self._read = 0
        """The bytes of whole lines that were read."""
        self._suspect = False
        """A change could not be stored and may be in the file all the same."""
        self.records = 0
        """The changes in the file."""

    def news(self) -> list[Change]:
        """Return the changes since the last call; a file that is another one starts with a clear.

        Raises
        ------
        InternalError
            A line that is not the last one is damaged, or is not a change; names it.
        StageUnavailable
            The file cannot be read. After either, the next call reads it from the beginning.
        """
        try:
            return self._news()
        except OSError as error:
            self.close()
            raise self._unreadable(error) from error
        except InternalError:
            self.close()
            raise

    def _news(self) -> list[Change]:
        try:
            status = self._file.stat()
        except (FileNotFoundError, NotADirectoryError):
            if self._handle is None:
                return []
            self.close()
            return [Change(clear=True)]
        if self._handle is not None:
            if os.fstat(self._handle).st_ino == status.st_ino:
                return [] if status.st_size == self._seen else self._tail()
            self.close()
        self._handle = os.open(self._file, os.O_RDONLY | os.O_CLOEXEC)
        return [Change(clear=True), *self._tail()]

    @contextlib.contextmanager
    def writing(self) -> Iterator[None]:
        """Keep other processes from writing.

        Raises
        ------
        NotStored
            The folder cannot be written.
        TooBusy
            Another process keeps it for seconds.
        """
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            lock = os.open(self._folder / "lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        except OSError as error:
            raise self._not_writable(error) from error
        try:
            try:
                _acquire(lock)
            except OSError as error:
                raise self._not_writable(error) from error
            yield
        finally:
            os.close(lock)

    def append(self, change: Change) -> None:
        """Store a change durably; inside `writing`, and with no news left.

        Raises
        ------
        NotStored
            It cannot be stored.
        """
        if self.needs_rewrite():
            raise ValueError("an incomplete end is dropped by `rewrite` before anything is added")
        line = _line(change)
        try:
            handle = os.open(self._file, os.O_WRONLY | os.O_APPEND | os.O_CLOEXEC)
            try:
                _write_all(handle, line)
                os.fsync(handle)
            finally:
                os.close(handle)
        except OSError as error:
            # Others may have read it meanwhile; a file that is another one undoes that.
            self._suspect = True
            with contextlib.suppress(OSError):
                os.truncate(self._file, self._read)
            raise self._not_writable(error) from error
        self._seen = self._read = self._read + len(line)
        self.records += 1

    def needs_rewrite(self) -> bool:
        """Say whether there is no file yet, or one whose end is not certain."""
        return self._handle is None or self._suspect or self._seen != self._read

    def rewrite(self, snapshot: Change) -> None:
        """Replace the file by one with a single change; inside `writing`.

        Raises
        ------
        NotStored
            It cannot be stored; the old file stays.
        """
        text = _HEADER + _line(snapshot)
        try:
            for left in self._folder.glob(".*.tmp"):  # by a process that was killed
                left.unlink()
            handle, name = tempfile.mkstemp(prefix=".", suffix=".tmp", dir=self._folder)
            part = Path(name)
            try:
                try:
                    _write_all(handle, text)
                    os.fsync(handle)
                finally:
                    os.close(handle)
                part.replace(self._file)
            except BaseException:
                part.unlink(missing_ok=True)
                raise
            self._sync_folder()
            self.close()
            self._handle = os.open(self._file, os.O_RDONLY | os.O_CLOEXEC)
        except OSError as error:
            raise self._not_writable(error) from error
        self._seen = self._read = len(text)
        self.records = 1

    def close(self) -> None:
        """Let go of the file."""
        if self._handle is not None:
            with contextlib.suppress(OSError):
                os.close(self._handle)
        self._handle, self._seen, self._read, self.records = None, 0, 0, 0
        self._suspect = False

    def _tail(self) -> list[Change]:
        """Return the changes in the whole lines after those that were read."""
        assert self._handle is not None
        size = os.fstat(self._handle).st_size
        lines = _read_all(self._handle, self._read, size).split(b"\n")[:-1]
        changes: list[Change] = []
        for number, line in enumerate(lines):
            if self._read == 0:
                self._check_header(line)
            else:
                change = self._change(line, last=number == len(lines) - 1)
                if change is None:
                    break
                changes.append(change)
                self.records += 1
            self._read += len(line) + 1
        self._seen = size
        return changes

    def _check_header(self, line: bytes) -> None:
        if line + b"\n" != _HEADER:
            raise InternalError(f"{self._file} is not a journal of this version: {line[:40]!r}")

    def _change(self, line: bytes, *, last: bool) -> Change | None:
        checksum, _, record = line.partition(b" ")
        if checksum != _checksum(record):
            if last:
                return None
            raise InternalError(f"{self._file}: record {self.records + 1} is damaged")
        try:
            return Change.model_validate_json(record)
        except ValidationError as error:
            raise InternalError(
                f"{self._file}: record {self.records + 1} is not a change: {error}"
            ) from error

    def _sync_folder(self) -> None:
        handle = os.open(self._folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)

    def _unreadable(self, error: OSError) -> StageUnavailable:
        return StageUnavailable(
            f"the knowledge folder {self._folder} cannot be read ({error.strerror})",
            stage="reasoning",
        )

    def _not_writable(self, error: OSError) -> NotStored:
        log.error("knowledge folder %s: %s", self._folder, error)
        return NotStored(
            f"reasoning cannot store the change ({error.strerror}); nothing of it was taken. "
            f"Make room for it, or set {_SETTING} to a folder that can be written",
            stage="reasoning",
            setting=_SETTING,
        )


def _acquire(lock: int) -> None:
    deadline = time.monotonic() + _WAIT_S
    while True:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > deadline:
                raise TooBusy("another process is changing the knowledge; ask again") from None
            time.sleep(0.005)
        else:
            return


def _line(change: Change) -> bytes:
    record = change.model_dump_json(exclude_defaults=True).encode()
    return _checksum(record) + b" " + record + b"\n"


def _checksum(record: bytes) -> bytes:
    return b"%08x" % zlib.crc32(record)


def _write_all(handle: int, data: bytes) -> None:
    while data:
        data = data[os.write(handle, data) :]


def _read_all(handle: int, start: int, end: int) -> bytes:
    pieces = []
    while start < end and (piece := os.pread(handle, end - start, start)):
        pieces.append(piece)
        start += len(piece)
    return b"".join(pieces)
