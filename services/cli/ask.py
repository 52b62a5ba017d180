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
from shared.client.trying import until_it_moves
from shared.client.view import points_of
from shared.errors import SpargeError
from shared.schemas.execution import ExecuteResponse
from shared.schemas.gripper import Gripper
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
    """The answer, the cloud that it speaks about, and what came of its grasps.

    Attributes
    ----------
    name : str
        Of what is seen, for titles.
    result : GraspResult
    points : (N, 3) array
        As the answer counts them, metres.
    gripper : ParallelGripper or SuctionGripper
        What the grasps are for.
    viewpoint : (3,) tuple
        Position of the sensor in the points' frame.
    tried : tuple of ExecuteResponse
        The grasps that were executed, best first; none unless a film was asked for.
    failure : SpargeError or None
        What ended the execution; the answer is worth having all the same.
    """

    name: str
    result: GraspResult
    points: Array
    gripper: Gripper
    viewpoint: tuple[float, float, float] = (0.0, 0.0, 0.0)
    tried: tuple[ExecuteResponse, ...] = ()
    failure: SpargeError | None = None

    @property
    def film(self) -> bytes | None:
        """An animated GIF of the last execution, if anything moved."""
        animation = self.tried[-1].animation if self.tried else None
        return None if animation is None else animation.tobytes()

    @property
    def why_no_film(self) -> str:
        """In a sentence."""
        if self.failure is not None:
            return f"{self.failure.code}: {self.failure.message}"
        if not self.tried:
            why = self.result.reason.message if self.result.reason else "the answer has no grasp"
            return f"there is no grasp to execute: {why}"
        return f"nothing moved in any of the {len(self.tried)} grasps: {self.tried[-1].message}"

    def object_cloud(self) -> tuple[Array, NDArray[np.int16], NDArray[np.bool_]]:
        """Return the object's points (N, 3), their primitive (N,) and whether in the region."""
        on_object = self.result.point_primitive >= 0
        return (
            self.points[on_object],
            self.result.point_primitive[on_object],
            self.result.point_region[on_object],
        )


def ask(question: Question, url: str | None, console: Console, *, film: bool = False) -> Answered:
    """Return the backend's answer, with a progress display on `console`.

    Parameters
    ----------
    question : Question
    url : str or None
        Of the backend; None: one in this process.
    console : Console
    film : bool
        Execute the grasps too, best first, until the robot finds a way to one.

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
            gripper = next(each for each in sparge.grippers() if each.name == result.answer.gripper)
            tried: tuple[ExecuteResponse, ...] = ()
            failure: SpargeError | None = None
            if film:
                progress.update(step, description="trying the grasps in simulation")
                tried, failure = _tried(sparge, result)
    x, y, z = question.parameters.get("viewpoint") or (0.0, 0.0, 0.0)
    return Answered(question.file.stem, result, points, gripper, (x, y, z), tried, failure)


def _tried(
    sparge: Sparge, result: GraspResult
) -> tuple[tuple[ExecuteResponse, ...], SpargeError | None]:
    """Return what came of the grasps, and the error that ended it, if one did."""
    requests = (result.execution(rank, animate=True) for rank in range(len(result.ranked)))
    try:
        return until_it_moves(sparge.execute, requests), None
    except SpargeError as error:
        return (), error


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
    return points_of(validate(View, held.fields()))
