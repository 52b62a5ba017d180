"""One question to a backend: a running one by URL, or one started in this process."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from shared.client import GraspResult, Sparge, connect
from shared.geometry.points import points_from_depth
from shared.schemas.scene import View
from shared.wire.codec import validate
from shared.wire.files import read_cloud_file

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Question:
    """A file, and the parameters of POST /grasp."""

    file: Path
    task: str
    parameters: dict[str, Any]


@dataclass(frozen=True)
class Answered:
    """The answer, and the cloud that it speaks about."""

    result: GraspResult
    points: Array

    def object_cloud(self) -> tuple[Array, NDArray[np.int16], NDArray[np.bool_]]:
        """Return the object's points (N, 3), their primitive (N,) and whether in the region."""
        on_object = self.result.point_primitive >= 0
        return (
            self.points[on_object],
            self.result.point_primitive[on_object],
            self.result.point_region[on_object],
        )


def ask(question: Question, url: str | None, console: Console) -> Answered:
    """Return the backend's answer, with a progress display on `console`.

    Raises
    ------
    SpargeError
        What the backend answered with.
    """
    data = question.file.read_bytes()
    points = _points(question, data)
    with Progress(
        SpinnerColumn(),
        TextColumn("{task.description}"),
        TimeElapsedColumn(),
        console=console,
        transient=True,
    ) as progress:
        step = progress.add_task("starting the stages" if url is None else f"asking {url}")
        with backend(url) as sparge:
            progress.update(step, description=f"grasping for {question.task}")
            result = sparge.grasp_file(
                question.file.name, data, question.task, **question.parameters
            )
    return Answered(result, points)


@contextlib.contextmanager
def backend(url: str | None) -> Iterator[Sparge]:
    """Give the backend at `url`, or the whole of it in this process."""
    if url is not None:
        with connect(url) as sparge:
            yield sparge
        return
    from services.wiring import embedded

    with embedded() as sparge:
        yield sparge


def _points(question: Question, data: bytes) -> Array:
    held = read_cloud_file(
        question.file.name,
        data,
        intrinsics=question.parameters.get("intrinsics"),
        depth_scale=question.parameters.get("depth_scale"),
    )
    view = validate(View, held.fields())
    if view.points is not None:
        return view.points
    assert view.depth is not None
    assert view.intrinsics is not None
    return points_from_depth(view.depth, view.intrinsics, view.depth_scale or 1.0)
