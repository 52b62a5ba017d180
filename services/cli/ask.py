"""One question to a backend: a running one by URL, or one started in this process."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx
import numpy as np
import orjson
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from shared.errors import StageUnavailable, error_from_envelope
from shared.geometry.points import points_from_depth
from shared.schemas.answer import GraspAnswer
from shared.schemas.scene import View
from shared.service.local import LocalClient, in_process
from shared.wire import NPZ
from shared.wire.codec import validate
from shared.wire.files import read_cloud_file
from shared.wire.npz import read_npz

_TIMEOUT_S = 120.0
_MAX_ANSWER_BYTES = 512 * 2**20


@dataclass(frozen=True)
class Question:
    """A file and the parameters of POST /grasp as form fields."""

    file: Path
    fields: dict[str, str]


@dataclass(frozen=True)
class Answered:
    """The answer, and the cloud that it speaks about."""

    answer: GraspAnswer
    points: NDArray[np.float64]
    point_primitive: NDArray[np.int16]
    point_region: NDArray[np.bool_]
    grasps: NDArray[np.float64]

    def object_cloud(
        self,
    ) -> tuple[NDArray[np.float64], NDArray[np.int16], NDArray[np.bool_]]:
        """Return the object's points (N, 3), their primitive (N,) and whether in the region."""
        on_object = self.point_primitive >= 0
        return (
            self.points[on_object],
            self.point_primitive[on_object],
            self.point_region[on_object],
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
        with _backend(url) as client:
            progress.update(step, description=f"grasping for {question.fields['task']}")
            response = client.request(
                "POST",
                "/grasp",
                data=question.fields,
                files={"file": (question.file.name, io.BytesIO(data))},
                headers={"Accept": NPZ},
            )
    if response.status_code != 200:
        raise _error(response)
    arrays = read_npz(response.content, _MAX_ANSWER_BYTES)
    report = arrays["report"].tobytes()
    return Answered(
        answer=GraspAnswer.model_validate_json(report),
        points=points,
        point_primitive=arrays["point_primitive"].astype(np.int16),
        point_region=arrays["point_region"].astype(np.bool_),
        grasps=arrays["grasps"].astype(np.float64),
    )


@contextlib.contextmanager
def _backend(url: str | None) -> Iterator[LocalClient]:
    if url is not None:
        with httpx.Client(base_url=url, timeout=_TIMEOUT_S) as http:
            try:
                yield LocalClient(http.request)
            except httpx.TransportError as error:
                raise StageUnavailable(f"no backend answers at {url}: {error}") from None
        return
    from services.wiring import create_app

    with in_process(create_app()) as client:
        yield client


def _points(question: Question, data: bytes) -> NDArray[np.float64]:
    intrinsics = question.fields.get("intrinsics")
    scale = question.fields.get("depth_scale")
    held = read_cloud_file(
        question.file.name,
        data,
        intrinsics=orjson.loads(intrinsics) if intrinsics else None,
        depth_scale=float(scale) if scale else None,
    )
    view = validate(View, held.fields())
    if view.points is not None:
        return view.points
    assert view.depth is not None
    assert view.intrinsics is not None
    return points_from_depth(view.depth, view.intrinsics, view.depth_scale or 1.0)


def _error(response: httpx.Response) -> Exception:
    try:
        body = orjson.loads(response.content)
    except orjson.JSONDecodeError:
        body = None
    error = error_from_envelope(response.status_code, body)
    return error or StageUnavailable(f"the backend answered {response.status_code}")
