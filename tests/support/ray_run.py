"""`python -m tests.support.ray_run`: annotate on Ray with the light pipeline, in a process alone.

Ray keeps threads and settings in the process that imports it, so tests start this.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from services.annotate.command import Options, annotate
from services.annotate.pipeline import Pipeline
from services.annotate.question import Question
from services.annotate.ray_session import private_ray
from tests.support.annotating import LightPipeline

QUESTION = Question(("pouring",), {"seed": 0})
ALL_AT_WORK, KILL_AT = 10, 30
_STARTED = "SPARGE_TEST_STARTED"


@contextlib.contextmanager
def start_light() -> Iterator[Pipeline]:
    """Start the light pipeline, and leave a file that says on which node."""
    import ray

    node = ray.get_runtime_context().get_node_id()
    (Path(os.environ[_STARTED]) / node).touch()
    yield LightPipeline()


def cluster(folder: Path, out: Path, started: Path) -> dict[str, Any]:
    """Annotate on two nodes of one CPU each; kill the second at `KILL_AT` settled questions."""
    private_ray()
    from ray.cluster_utils import Cluster

    os.environ[_STARTED] = str(started)
    nodes = Cluster(
        initialize_head=True,
        head_node_args={"num_cpus": 1, "include_dashboard": False, "include_log_monitor": False},
    )
    second = nodes.add_node(num_cpus=1)
    told: dict[str, Any] = {}

    def progress(settled: int, _: int) -> None:
        if settled >= ALL_AT_WORK and "workers_on" not in told:
            while len(on := [path.name for path in started.iterdir()]) < 2:
                time.sleep(0.1)
            told.update(workers_on=sorted(on), listens_on=sorted(listening()))
        if settled >= KILL_AT and "killed" not in told:
            nodes.remove_node(second, allow_graceful=False)
            told.update(killed=second.node_id, settled_then=settled)

    options = Options(nodes.address, part_rows=8, start=start_light, patience_s=1.0)
    summary = annotate(folder, out, QUESTION, options, progress)
    nodes.shutdown()
    return {**told, "annotated": summary.annotated}


def listening() -> set[str]:
    """Return the addresses that this process and all below it listen on, as the kernel has them."""
    ours = {os.getpid()}
    for _ in range(4):  # driver, raylet, worker, and what that starts
        ours |= {process for process, parent in parents().items() if parent in ours}
    sockets = {
        str(link.readlink())
        for process in ours
        for link in Path(f"/proc/{process}/fd").glob("*")
        if link.is_symlink()
    }
    found = set()
    for table in ("tcp", "tcp6"):
        for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]:
            fields = line.split()
            if fields[3] == "0A" and f"socket:[{fields[9]}]" in sockets:
                found.add(fields[1].partition(":")[0])
    return found


def parents() -> dict[int, int]:
    """Return the parent of every process."""
    found = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):  # ended meanwhile
            found[int(path.parent.name)] = int(path.read_text().rpartition(")")[2].split()[1])
    return found


if __name__ == "__main__":
    what, *places = sys.argv[1:]
    sys.stdout.write(json.dumps({"cluster": cluster}[what](*map(Path, places))) + "\n")
