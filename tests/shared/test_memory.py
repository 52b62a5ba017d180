"""Freed arrays stay in the process."""

from __future__ import annotations

import platform
import subprocess
import sys

import pytest

from shared.settings import PROJECT_ROOT

PROGRAM = """
import resource, sys
import numpy as np
from shared.service.memory import keep_freed_memory
if sys.argv[1] == "keep":
    assert keep_freed_memory()
def work():
    arrays = [np.ones(600_000) for _ in range(5)]  # 4.8 MB each
work()
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
for _ in range(10):
    work()
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


def faults(mode: str) -> int:
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM, mode],
        cwd=PROJECT_ROOT,
        check=True,
        capture_output=True,
        text=True,
    )
    return int(run.stdout)


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="only glibc can be told")
def test_arrays_are_not_mapped_anew() -> None:
    assert faults("keep") < 100
    assert faults("default") > 1000
