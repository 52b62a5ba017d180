"""Kernels compile with and without a cache on disk."""

from __future__ import annotations

import concurrent.futures
import json
import os
import subprocess
import sys
from pathlib import Path

from shared.settings import PROJECT_ROOT

WARM_UP = """
import json
from services.primitive_recovery.recovery import PrimitiveRecovery
from services.primitive_recovery.settings import PrimitiveRecoverySettings
from shared.jit import types_compiled
recovery = PrimitiveRecovery(PrimitiveRecoverySettings())
recovery.warm_up()
recovery.warm_up_ems()
print(json.dumps(types_compiled()))
"""


def test_processes_that_start_together_share_an_empty_cache(tmp_path: Path) -> None:
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path), "OMP_NUM_THREADS": "1"}

    def start() -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-c", WARM_UP],
            env=environment,
            cwd=PROJECT_ROOT,
            capture_output=True,
            text=True,
            timeout=900,
            check=False,
        )

    with concurrent.futures.ThreadPoolExecutor() as pool:
        runs = [one.result() for one in [pool.submit(start) for _ in range(2)]]
    for run in (*runs, start()):
        assert run.returncode == 0, run.stderr
        # At most one combination of types each, or processes could overwrite each other's
        # entries. (None: it was loaded within a caller. What only kernels of the same file
        # call is compiled with them, in their order.)
        types = json.loads(run.stdout)
        shared = {name: n for name, n in types.items() if not name.split(".")[-1].startswith("_")}
        assert {name: n for name, n in shared.items() if n > 1} == {}
        assert len(types) > 20
    assert any(tmp_path.rglob("*.nbi"))
