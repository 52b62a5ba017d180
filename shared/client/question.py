"""What can be asked, as requests that no transport has sent yet.

`Sparge` and `AsyncSparge` differ in how they send a `Question` and wait; what is asked, what an
answer means and what may be asked again is here.
"""

from __future__ import annotations

import os
import uuid
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

import httpx
import numpy as np
from pydantic import BaseModel, ValidationError

from shared.client.parameters import GraspParameters, as_texts
from shared.client.result import GraspResult
from shared.client.view import ViewLike, arrays_of
from shared.errors import (
    InvalidInput,
    MalformedRequest,
    PayloadTooLarge,
    StageUnavailable,
)
from shared.schemas.answer import EXPLANATION, GraspAnswer, KeptExplanation, RequestName
from shared.schemas.route import Request, Response, Route
from shared.schemas.task import ADD_TASK, DELETE_TASK, Task, TaskDefinition, TaskName
from shared.service.app import Health, Version
from shared.service.client import MAX_ANSWER_BYTES, check, compose, read, unavailable
from shared.service.request_id import REQUEST_ID_HEADER, request_id
from shared.service.tracing import inject
from shared.wire import NPZ
from shared.wire.codec import validate
from shared.wire.npz import read_npz, write_npz

T = TypeVar("T")
M = TypeVar("M", bound=BaseModel)

BACKEND = "backend"


def invites_again(answer: httpx.Response) -> bool:
    """Whether the backend says that it cannot answer now, and when to ask again."""
    return answer.status_code in (429, 503) and "retry-after" in answer.headers


@dataclass(frozen=True)
class Question(Generic[T]):
    """A request, and what its answer means.

    Attributes
    ----------
    method, url : str
    headers : mapping
        With the request's id, the same however often it is asked.
    body : mapping
        `params`, `content`, `data`, `files` as httpx takes them; can be sent again.
    read : callable
        From the answer to what is wanted, or raises the error that it is.
    changes : bool
        It changes what the backend knows: asking twice is not asking once.
    again : callable
        Whether an answer invites to ask again.
    """

    method: str
    url: str
    headers: Mapping[str, str]
    body: Mapping[str, Any]
    read: Callable[[httpx.Response], T]
    changes: bool = False
    again: Callable[[httpx.Response], bool] = invites_again


def grasp(view: ViewLike, task: str, parameters: GraspParameters) -> Question[GraspResult]:
    """Ask where and how to grasp what a view shows."""
    if isinstance(view, os.PathLike):
        path = Path(view)
        return grasp_file(path.name, path.read_bytes(), task, parameters)
    fields = {"task": task, **parameters}
    arrays = arrays_of(view, fields.pop("intrinsics", None), fields.pop("depth_scale", None))  # type: ignore[arg-type]
    content = write_npz(arrays)
    return _grasp({"Content-Type": NPZ}, {"params": as_texts(fields), "content": content})


def grasp_file(
    name: str, data: bytes, task: str, parameters: GraspParameters
) -> Question[GraspResult]:
    """Ask the same about a file; `name` says of which kind it is."""
    fields = as_texts({"task": task, **parameters})
    return _grasp({}, {"data": fields, "files": {"file": (name, data)}})


def _grasp(headers: Mapping[str, str], body: Mapping[str, Any]) -> Question[GraspResult]:
    return Question("POST", "/grasp", _headers({"Accept": NPZ, **headers}), body, _result)


def routed(route: Route[Request, Response], request: Request) -> Question[Response]:
    """Ask any endpoint that has a `Route`."""
    body = compose(route, request)
    method, url, headers = (body.pop(name) for name in ("method", "url", "headers"))

    def answered(response: httpx.Response) -> Response:
        return read(BACKEND, route, response)

    return Question(method, url, _headers(headers), body, answered, changes=route.changes)


def add_task(
    name: str,
    description: str,
    requires: Iterable[str],
    grasp: Iterable[str],
    avoids: Iterable[str],
) -> Question[Task]:
    """Add a Version 2 task by its relations to affordances."""
    fields = {
        "name": name,
        "description": description,
        "requires": _names("requires", requires),
        "grasp": _names("grasp", grasp),
        "avoids": _names("avoids", avoids),
    }
    return routed(ADD_TASK, validate(TaskDefinition, fields))


def remove_task(name: str) -> Question[Task]:
    """Forget a task that was added."""
    return routed(DELETE_TASK, validate(TaskName, {"name": name}))


def explanation(identifier: str) -> Question[KeptExplanation]:
    """Ask why an earlier request was answered as it was."""
    return routed(EXPLANATION, validate(RequestName, {"request_id": identifier}))


def version() -> Question[Version]:
    """Ask which build answers."""

    def answered(response: httpx.Response) -> Version:
        check(BACKEND, response)
        return _model(Version, response)

    return Question("GET", "/version", _headers({}), {}, answered)


def health() -> Question[Health]:
    """Ask whether the backend can work; one that cannot yet is an answer."""

    def answered(response: httpx.Response) -> Health:
        if response.status_code not in (200, 503):
            check(BACKEND, response)
        return _model(Health, response)

    return Question("GET", "/health/ready", _headers({}), {}, answered)


def readiness() -> Question[bool]:
    """Ask whether it is ready; to be asked again while it is starting."""

    def answered(response: httpx.Response) -> bool:
        found = health().read(response)
        if found.status != "ready":
            waiting = "; ".join(f"{name}: {why}" for name, why in found.details.items())
            raise unavailable(BACKEND, f"is not ready: {waiting or found.status}")
        return True

    def starting(response: httpx.Response) -> bool:
        if response.status_code != 503:
            return False
        try:
            return health().read(response).status != "failed"
        except StageUnavailable:  # of who stands in front of it
            return True

    return Question("GET", "/health/ready", _headers({}), {}, answered, again=starting)


def _result(response: httpx.Response) -> GraspResult:
    check(BACKEND, response)
    try:
        arrays = read_npz(response.content, MAX_ANSWER_BYTES)
        return GraspResult(
            answer=GraspAnswer.model_validate_json(arrays["report"].tobytes()),
            point_primitive=arrays["point_primitive"].astype(np.int16),
            point_region=arrays["point_region"].astype(np.bool_),
            grasps=arrays["grasps"].astype(np.float64),
        )
    except (MalformedRequest, PayloadTooLarge, KeyError, ValidationError) as error:
        raise _nonsense(error) from None


def _model(kind: type[M], response: httpx.Response) -> M:
    try:
        return kind.model_validate_json(response.content)
    except ValidationError as error:
        raise _nonsense(error) from None


def _nonsense(error: Exception) -> Exception:
    found = f"{type(error).__name__}: {error}".splitlines()[0]
    return unavailable(BACKEND, f"answered nonsense; is its URL right? ({found})")


def _headers(headers: Mapping[str, str]) -> dict[str, str]:
    """Return headers with the trace that this is part of, and an id of the request."""
    known = request_id.get()
    identifier = uuid.uuid4().hex if known == "-" else known
    return inject({**headers, REQUEST_ID_HEADER: identifier})


def _names(field: str, names: Iterable[str]) -> tuple[str, ...]:
    if isinstance(names, str):
        raise InvalidInput(
            f"{field} takes a list of affordances; found the text {names!r}",
            field=field,
            found=names,
        )
    return tuple(names)
