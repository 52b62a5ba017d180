"""Keep freed memory in the process, where the C library can be told to."""

from __future__ import annotations

import ctypes

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8  # of glibc's malloc.h
_KEEP_BYTES = 2**28
_LARGEST_MAPPED_BYTES = 2**25  # the most that glibc accepts


def keep_freed_memory() -> bool:
    """Tell the allocator to hand freed arrays out again rather than back to the system.

    A request works on a few dozen arrays of some megabytes. By default glibc returns each
    of them to the system when it is freed, and the next request pays for clearing and
    mapping its pages again, one fault per 4 kB: a third of the time of perception. One
    arena for all threads, so that they share what is kept; up to 256 MB of it.

    Returns
    -------
    bool
        False where the C library is not glibc; then nothing changes.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is None:
        return False
    wanted = (
        (_TRIM_THRESHOLD, _KEEP_BYTES),
        (_MMAP_THRESHOLD, _LARGEST_MAPPED_BYTES),
        (_ARENA_MAX, 1),
    )
    return all(mallopt(parameter, value) == 1 for parameter, value in wanted)
