"""`python -m tests.support.ray_run`: annotate on Ray with the light pipeline, in a process alone.

Ray keeps threads and settings in the process that imports it, so tests start this.
"""

from __future__ import annotations

import json
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
        initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False}
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
        driver = Driver(folder, QUESTION, terms, book, 1000, progress=kill)
        summary = driver.run(find_inputs(folder), pool)
        told["nodes_after"] = sum(node["Alive"] for node in ray.nodes())
    nodes.shutdown()
    return {**told, "annotated": summary.annotated}


if __name__ == "__main__":
    what, *places = sys.argv[1:]
    sys.stdout.write(json.dumps({"cluster": cluster}[what](*map(Path, places))) + "\n")
