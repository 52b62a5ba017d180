"""`python -m tests.support.ray_run`: annotate on Ray with the light pipeline, in a process alone.

Ray keeps threads and settings in the process that imports it, so tests start this.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
from pathlib import Path
from typing import Any

from services.annotate.book import Book
from services.annotate.drive import Driver
from services.annotate.inputs import find_inputs
from services.annotate.question import Question
from services.annotate.ray_session import private_ray, ray_session
from tests.support.annotating import start_light

QUESTION = Question(("pouring",), {"seed": 0})
KILL_AT = 20
PATIENCE_S = 1.0


def cluster(folder: Path, out: Path) -> dict[str, Any]:
    """Run on two nodes of one CPU each; kill the second when `KILL_AT` questions are settled."""
    private_ray()
    import ray
    from ray.cluster_utils import Cluster

    from services.annotate.ray_pool import RayPool

    nodes = Cluster(
        initialize_head=True,
        head_node_args={"num_cpus": 1, "include_dashboard": False, "include_log_monitor": False},
    )
    second = nodes.add_node(num_cpus=1)
    told: dict[str, Any] = {}

    def kill(settled: int) -> None:
        if settled >= KILL_AT and "settled_at_the_kill" not in told:
            told["settled_at_the_kill"] = settled
            nodes.remove_node(second, allow_graceful=False)

    with (
        ray_session(nodes.address, None) as workers,
        Book(out, part_rows=8) as book,
        RayPool(workers, start_light, QUESTION, {}, PATIENCE_S) as pool,
    ):
        told["nodes_before"] = sum(node["Alive"] for node in ray.nodes())
        terms = pool.start()
        while pool.ready < workers:
            pool.take()
        told["listens_on"] = sorted(listening())
        driver = Driver(folder, QUESTION, terms, book, 1000, progress=kill)
        summary = driver.run(find_inputs(folder), pool)
        told["nodes_after"] = sum(node["Alive"] for node in ray.nodes())
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
