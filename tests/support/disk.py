"""A disk that can be full, read-only or broken: a small real one, or the system calls to it."""

from __future__ import annotations

import contextlib
import errno
import os
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Protocol

import pytest

SIZE_KIB = 64
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT


class Disk(Protocol):
    """A folder on a disk that fails when it is told to."""

    folder: Path

    def full(self) -> contextlib.AbstractContextManager[None]:
        """Have no room for a while."""

    def read_only(self) -> contextlib.AbstractContextManager[None]:
        """Take no changes for a while."""


class SmallDisk:
    """A file system of its own, in memory; needs the right to mount."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @contextlib.contextmanager
    def full(self) -> Iterator[None]:
        ballast = self.folder / "ballast"
        with ballast.open("wb", buffering=0) as file, contextlib.suppress(OSError):
            while True:
                file.write(bytes(512))
        try:
            yield
        finally:
            ballast.unlink()

    @contextlib.contextmanager
    def read_only(self) -> Iterator[None]:
        self._remount("ro")
        try:
            yield
        finally:
            self._remount("rw")

    def _remount(self, how: str) -> None:
        subprocess.run(["mount", "-o", f"remount,{how}", self.folder], check=True)


@contextlib.contextmanager
def small_disk(folder: Path) -> Iterator[SmallDisk]:
    """Mount one, or skip the test where that is not allowed."""
    options = ["-t", "tmpfs", "-o", f"size={SIZE_KIB}k", "tmpfs", str(folder)]
    try:
        subprocess.run(["mount", *options], check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError) as error:
        pytest.skip(f"no file system can be mounted here: {error}")
    try:
        yield SmallDisk(folder)
    finally:
        subprocess.run(["umount", "-l", folder], check=True)


class FailingCalls:
    """System calls that fail for files in a folder, and for no others.

    Parameters
    ----------
    folder : Path
    patch : pytest.MonkeyPatch
        Undoes it at the end of the test.

    Attributes
    ----------
    made : int
        The calls that change something, since it was set to 0.
    """

    def __init__(self, folder: Path, patch: pytest.MonkeyPatch) -> None:
        self.folder = folder
        self.made = 0
        self._fails: Callable[[str], int | None] = lambda call: None
        patch.setattr(os, "open", self._watched("open", os.open))
        patch.setattr(os, "write", self._watched("write", os.write))
        patch.setattr(os, "fsync", self._watched("fsync", os.fsync))
        patch.setattr(os, "truncate", self._watched("truncate", os.truncate))
        patch.setattr(os, "replace", self._watched("replace", os.replace))
        patch.setattr(os, "unlink", self._watched("unlink", os.unlink))
        patch.setattr(os, "mkdir", self._watched("mkdir", os.mkdir))

    @contextlib.contextmanager
    def failing(self, fails: Callable[[str], int | None]) -> Iterator[None]:
        """Fail for a while: `fails` is told each call by name and returns an errno or None."""
        self._fails = fails
        try:
            yield
        finally:
            self._fails = lambda call: None

    def full(self) -> contextlib.AbstractContextManager[None]:
        return self.failing(lambda call: errno.ENOSPC if call == "write" else None)

    def read_only(self) -> contextlib.AbstractContextManager[None]:
        return self.failing(lambda call: None if call in ("write", "fsync") else errno.EROFS)

    def failing_at(self, number: int, error: int) -> contextlib.AbstractContextManager[None]:
        """Fail the call of this number, from 0, and all after it."""
        self.made = 0
        return self.failing(lambda call: error if self.made > number else None)

    def _watched(self, name: str, call: Callable[..., Any]) -> Callable[..., Any]:
        def watched(target: Any, *arguments: Any, **options: Any) -> Any:
            if not self._concerns(name, target, *arguments):
                return call(target, *arguments, **options)
            self.made += 1
            error = self._fails(name)
            if error is None:
                return call(target, *arguments, **options)
            if name == "write":  # as a disk does that fills up: some of it is written
                call(target, bytes(arguments[0])[: len(arguments[0]) // 2])
            raise OSError(error, os.strerror(error))

        return watched

    def _concerns(self, name: str, target: Any, *arguments: Any) -> bool:
        if name == "open" and not arguments[0] & _WRITING:
            return False
        place = f"/proc/self/fd/{target}" if isinstance(target, int) else target
        return Path(os.path.realpath(place)).is_relative_to(self.folder.resolve())
