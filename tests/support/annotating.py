"""A pipeline that answers at once from the bytes alone: for tests of what is around it."""

from __future__ import annotations

import hashlib
import os
import time
from pathlib import Path
from typing import Any

import numpy as np

from services.annotate.question import Question
from shared.client import GraspResult
from shared.errors import DeadlineExceeded, EmptyCloud
from shared.schemas.answer import GraspAnswer, LabelledPrimitive, Scene
from shared.schemas.task import Reason, Region

SECONDS = 0.02


class LightPipeline:
    """Answers by the first word of a file: empty, slow, poison, bug, hang, or any other.

    `hang` is followed by the path of a file: where there is none it makes it and hangs.

    Same bytes, task and seed: same answer, but for id and timings.
    """

    def check(self, question: Question) -> str:
        return "light"

    def grasp_file(self, name: str, data: bytes, task: str, **parameters: Any) -> GraspResult:
        time.sleep(SECONDS)
        match data.split()[0]:
            case b"empty":
                raise EmptyCloud("no points")
            case b"slow":
                raise DeadlineExceeded("not in time")
            case b"poison":
                os._exit(9)
            case b"hang" if not (marker := Path(data.split()[1].decode())).exists():
                marker.touch()
                time.sleep(600)
            case b"bug":
                raise ZeroDivisionError("a bug")
        seed = hashlib.sha256(data + task.encode() + str(parameters.get("seed")).encode()).digest()
        return answer(np.random.default_rng(list(seed)), task, found=b"nothing" not in data)


def answer(rng: np.random.Generator, task: str, *, found: bool = True) -> GraspResult:
    """Return some answer about 50 points, the second half of which are on two parts."""
    assigned = np.where(np.arange(50) < 25, -1, rng.choice([0, 1], 50)).astype(np.int16)
    primitives = tuple(
        LabelledPrimitive(
            id=number,
            parameters=tuple(rng.uniform(0.1, 1.0, 12).tolist()),
            shape_class="cuboid",
            shape_probability=0.5,
            full_extents=(0.1, 0.1, 0.1),
            residual_mm=1.0,
            support=12,
        )
        for number in (0, 1)
    )
    return GraspResult(
        answer=GraspAnswer(
            request_id=os.urandom(8).hex(),
            task=task,
            reasoning="v2",
            rule_set="default",
            gripper="panda",
            seed=0,
            frame_id="camera",
            found=found,
            reason=None if found else Reason(code="no_part_matches", message="none does"),
            region=Region(primitive_ids=(1,), confidence=0.75) if found else None,
            alternatives=(),
            primitives=primitives,
            grasps=(),
            explanation=None,
            scene=Scene(
                plane=None,
                up=(0.0, 0.0, 1.0),
                object_points=25,
                clusters=1,
                dropped={},
                method="parts",
                removed_as_overlap=0,
                candidates=0,
                rejected={},
            ),
            timings_ms={"total": time.perf_counter()},
        ),
        point_primitive=assigned,
        point_region=(assigned == 1) & found,
        grasps=rng.uniform(0.0, 1.0, (3 if found else 0, 9)),
    )


def write_inputs(folder: Path, contents: dict[str, str]) -> Path:
    """Write files by their names below `folder`; return it."""
    for name, text in contents.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def rows(out: Path) -> dict[tuple[str, str], dict[str, Any]]:
    """Return the annotations by path and task, as any reader sees them."""
    return _by_key(out / "annotations")


def rejects(out: Path) -> dict[tuple[str, str], dict[str, Any]]:
    """Return the rejects by path and task."""
    return _by_key(out / "rejects")


def settled(out: Path) -> list[tuple[str, str]]:
    """Return the keys of all rows of both tables, in order and as often as they are there."""
    import pyarrow.parquet as pq

    tables = [pq.read_table(out / name) for name in ("annotations", "rejects")]
    return sorted((row["path"], row["task"]) for table in tables for row in table.to_pylist())


def _by_key(folder: Path) -> dict[tuple[str, str], dict[str, Any]]:
    import pyarrow.parquet as pq

    return {(row["path"], row["task"]): row for row in pq.read_table(folder).to_pylist()}
