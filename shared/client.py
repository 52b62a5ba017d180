"""The client that people use: a view and a task in, the answer with its arrays out.

    from shared.client import connect

    with connect("http://127.0.0.1:8000") as sparge:
        answer = sparge.grasp({"points": points}, task="pouring")

It speaks the public contract only, so it works with any backend.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import httpx
import numpy as np
from numpy.typing import ArrayLike, NDArray

from shared.schemas.answer import GraspAnswer
from shared.schemas.route import Request, Response, Route
from shared.service.client import MAX_ANSWER_BYTES, check, compose, read, unavailable
from shared.service.tracing import inject
from shared.wire import NPZ, Message
from shared.wire.npz import read_npz, write_npz

BACKEND = "backend"
API_KEY_VARIABLE = "SPARGE_API_KEY"


@dataclass(frozen=True)
class GraspResult:
    """The answer to POST /grasp and its arrays.

    Attributes
    ----------
    answer : GraspAnswer
        Region, primitives, grasps, explanation, timings.
    point_primitive : (N,) int16 array
        Id of the primitive of every INPUT point, -1: none. A depth image has H*W
        points, row-major.
    point_region : (N,) bool array
        Whether the input point is part of what to hold.
    grasps : (G, 9) array
        x y z qx qy qz qw width score, best first.
    """

    answer: GraspAnswer
    point_primitive: NDArray[np.int16]
    point_region: NDArray[np.bool_]
    grasps: NDArray[np.float64]


class Sparge:
    """A backend.

    Parameters
    ----------
    send : callable
        As `httpx.Client.request`.
    """

    def __init__(self, send: Callable[..., httpx.Response]) -> None:
        self._send = send

    def grasp(self, view: Mapping[str, ArrayLike], task: str, **parameters: Any) -> GraspResult:
        """Ask where and how to grasp what `view` shows.

        Parameters
        ----------
        view : mapping
            `points` (N, 3) in metres; or `depth` (H, W), `intrinsics` (3, 3), `depth_scale`.
        task : str
            A name from the backend's tasks.
        **parameters
            The others of POST /grasp: reasoning, input, viewpoint, target, gripper,
            max_grasps, seed, method, recovery, explain, frame_id. `recovery` takes
            `EmsParameters` (shared/schemas/primitive.py) or a mapping of their names.

        Raises
        ------
        SpargeError
            What the backend answered with.
        StageUnavailable
            It does not answer, or answers nonsense.
        """
        return self._grasp(
            params=_query({"task": task, **parameters}),
            content=write_npz(view),
            headers={"Content-Type": NPZ},
        )

    def grasp_file(self, name: str, data: bytes, task: str, **parameters: Any) -> GraspResult:
        """Ask about a `.ply`, `.pcd`, `.xyz`, `.npz` or 16-bit `.png` file.

        A depth image needs `intrinsics` and `depth_scale` among the parameters.
        """
        fields = _query({"task": task, **parameters})
        return self._grasp(data=fields, files={"file": (name, data)})

    def call(self, route: Route[Request, Response], request: Request) -> Response:
        """Ask any other endpoint, as in `call(LIST_TASKS, Nothing())`."""
        return read(BACKEND, route, self._request(**compose(route, request)))

    def _grasp(self, headers: Mapping[str, str] | None = None, **options: Any) -> GraspResult:
        response = self._request(
            method="POST",
            url="/grasp",
            headers=inject({"Accept": NPZ, **(headers or {})}),
            **options,
        )
        check(BACKEND, response)
        arrays = read_npz(response.content, MAX_ANSWER_BYTES)
        return GraspResult(
            answer=GraspAnswer.model_validate_json(arrays["report"].tobytes()),
            point_primitive=arrays["point_primitive"].astype(np.int16),
            point_region=arrays["point_region"].astype(np.bool_),
            grasps=arrays["grasps"].astype(np.float64),
        )

    def _request(self, *, method: str, url: str, **options: Any) -> httpx.Response:
        try:
            return self._send(method, url, **options)
        except httpx.RequestError as error:
            raise unavailable(BACKEND, f"cannot be reached: {error}") from None


@contextlib.contextmanager
def connect(url: str, timeout_s: float = 120.0, api_key: str | None = None) -> Iterator[Sparge]:
    """Speak to the backend at `url`.

    Parameters
    ----------
    timeout_s : float
        How long to wait for an answer.
    api_key : str, optional
        For a backend that wants one; else that of the environment, `API_KEY_VARIABLE`.
    """
    with httpx.Client(base_url=url, timeout=timeout_s, headers=key_headers(api_key)) as http:
        yield Sparge(http.request)


def key_headers(api_key: str | None = None) -> dict[str, str]:
    """Return the headers that show an API key: this one, or that of the environment, if any."""
    key = api_key or os.environ.get(API_KEY_VARIABLE)
    return {"Authorization": f"Bearer {key}"} if key else {}


def _query(parameters: Mapping[str, Any]) -> dict[str, str]:
    """Return parameters as texts: vectors, matrices, mappings and messages as JSON."""
    texts: dict[str, str] = {}
    for name, value in parameters.items():
        if value is None:
            continue
        if isinstance(value, bool):
            texts[name] = str(value).lower()
        elif isinstance(value, str | int | float):
            texts[name] = str(value)
        elif isinstance(value, Message):
            texts[name] = value.model_dump_json()
        elif isinstance(value, Mapping):
            texts[name] = json.dumps(dict(value))
        else:
            texts[name] = str(np.asarray(value).tolist())
    return texts
