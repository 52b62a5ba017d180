"""Uploaded files, read in a process that may crash, hang or run out of memory."""

from __future__ import annotations

import os
import signal
import threading
from typing import Any

import numpy as np
import orjson

from services.gateway.settings import GatewaySettings
from shared.child import Child, ChildEnded, ChildTooSlow
from shared.errors import DeadlineExceeded, StageUnavailable, TooBusy, UnreadableFile
from shared.wire.files import CloudFile, extension_of, read_cloud_file
from shared.wire.npz import read_npy

READ_ELSEWHERE = (".ply", ".pcd", ".xyz", ".png")
"""npz is not: its reader is our own, on zlib alone, and reads whole bodies in this process."""
PASSED_ON = ("PATH", "LD_LIBRARY_PATH", "LANG", "TMPDIR")
"""Of the environment; keys and passwords in it are no business of the other process."""
HEADERS = 2**16
"""What an answer may have beside what the file unpacks to."""
TUNED = {
    "OPENBLAS_NUM_THREADS": "1",
    "MALLOC_ARENA_MAX": "1",  # keep what is freed, as shared/service/memory.py does here
    "MALLOC_TRIM_THRESHOLD_": str(2**28),
    "MALLOC_MMAP_THRESHOLD_": str(2**25),
}


class FileReader:
    """Reads files, one after the other; may be used from several threads.

    The process is started for the first file that needs it and again after it ended.

    Parameters
    ----------
    settings : GatewaySettings
        Bounds on the size, the memory and the time of a file.
    """

    def __init__(self, settings: GatewaySettings) -> None:
        self._settings = settings
        self._lock = threading.Lock()
        self._child: Child | None = None

    def read(
        self, name: str, data: bytes, *, intrinsics: Any = None, depth_scale: Any = None
    ) -> CloudFile:
        """Return the points or the depth image of a file, as `read_cloud_file` does.

        Parameters
        ----------
        name : str
            Its extension says the format.
        data : bytes
            The file.
        intrinsics, depth_scale : JSON-compatible, optional
            Beside a depth image that does not hold them.

        Raises
        ------
        SpargeError
            As `read_cloud_file`.
        UnreadableFile
            It takes too much memory or time, or crashes what reads it.
        TooBusy
            The files before it take too long.
        DeadlineExceeded
            This machine is too busy to read it in time.
        """
        beside = {"intrinsics": intrinsics, "depth_scale": depth_scale}
        limit = self._settings.max_unpacked_bytes
        extension = extension_of(name)
        if extension not in READ_ELSEWHERE:
            return read_cloud_file(name, data, **beside, max_unpacked_bytes=limit)
        question = {
            "name": f"file{extension}",
            **beside,
            "max_unpacked_bytes": limit,
        }
        beside_array, array = self._ask(orjson.dumps(question), data)
        held = orjson.loads(beside_array)
        held[held.pop("array")] = read_npy(array, name)
        matrix = held.get("intrinsics")
        return CloudFile(
            points=held.get("points"),
            depth=held.get("depth"),
            intrinsics=None if matrix is None else np.asarray(matrix, np.float64),
            depth_scale=held.get("depth_scale"),
        )

    def close(self) -> None:
        """End the process."""
        with self._lock:
            if self._child is not None:
                self._child.stop()
            self._child = None

    def _ask(self, question: bytes, data: bytes) -> list[bytes]:
        wait_s = self._settings.deadline_s
        if not self._lock.acquire(timeout=wait_s):
            raise TooBusy("other files are still being read; ask again", stage="gateway")
        try:
            most = self._settings.max_unpacked_bytes + HEADERS
            return self._running().ask(question, data, limit_s=wait_s, max_answer_bytes=most)
        except ChildTooSlow:
            raise DeadlineExceeded(
                f"the file could not be read within {wait_s:g} s", stage="gateway"
            ) from None
        except ChildEnded as end:
            raise self._unreadable(end) from None
        finally:
            self._lock.release()

    def _running(self) -> Child:
        if self._child is None or not self._child.alive:
            if self._child is not None:
                self._child.stop()
            passed_on = {name: os.environ[name] for name in PASSED_ON if name in os.environ}
            try:
                self._child = Child(
                    "services.gateway.file_process",
                    str(self._settings.file_memory_bytes),
                    str(self._settings.file_time_s),
                    environment={**passed_on, **TUNED},
                )
            except (ChildEnded, OSError) as error:
                raise StageUnavailable(
                    f"the process that reads files does not start: {error}", stage="gateway"
                ) from error
        return self._child

    def _unreadable(self, end: ChildEnded) -> UnreadableFile:
        if end.exit_status == -signal.SIGPROF:
            limit_s = self._settings.file_time_s
            return UnreadableFile(
                f"reading the file takes more than {limit_s:g} s of processor time",
                field="file",
                allowed=limit_s,
            )
        return UnreadableFile(
            f"the file ends what reads it ({end}): it is damaged, or takes too much memory",
            field="file",
            found=str(end),
        )
