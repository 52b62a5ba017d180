"""The calls of the service: how each is asked over HTTP, and how its answer is read."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, TypeVar
from urllib.parse import quote

import numpy as np

from services.grpc import answer, execution, known, request
from services.grpc.generated import sparge_pb2 as pb
from services.grpc.request import HttpRequest
from shared.errors import SpargeError, StageUnavailable
from shared.schemas.answer import EXPLANATION, GraspAnswer, RequestName
from shared.schemas.execution import EXECUTE
from shared.schemas.grasp import LIST_GRIPPERS
from shared.schemas.route import Route
from shared.schemas.task import ADD_TASK, DELETE_TASK, LIST_AFFORDANCES, LIST_TASKS, TaskName
from shared.wire import JSON, NPZ, Message, decode
from shared.wire.codec import validate
from shared.wire.npz import read_npz

_MAX_ANSWER_BYTES = 512 * 2**20
Out = TypeVar("Out", bound=Message)


@dataclass(frozen=True)
class Call:
    """One method of the service.

    Attributes
    ----------
    ask : callable
        The call's message -> the HTTP request; raises `InvalidInput` for what cannot be asked.
    read : callable
        Media type and body of the HTTP answer -> the call's answer.
    """

    ask: Callable[[Any], HttpRequest]
    read: Callable[[str, bytes], Any]


def _explain(asked: pb.RequestName) -> HttpRequest:
    named = validate(RequestName, {"request_id": asked.request_id})
    return request.get(_filled(EXPLANATION, request_id=named.request_id))


def _delete_task(asked: pb.TaskName) -> HttpRequest:
    named = validate(TaskName, {"name": asked.name})
    return request.delete(_filled(DELETE_TASK, name=named.name))


def _read_grasp(media_type: str, body: bytes) -> pb.GraspAnswer:
    if NPZ not in media_type:
        return answer.grasp_answer(_from_json(GraspAnswer, body))
    arrays = read_npz(body, _MAX_ANSWER_BYTES)
    read = answer.grasp_answer(_from_json(GraspAnswer, arrays["report"].tobytes()))
    read.points.primitive = arrays["point_primitive"].astype("<i2").tobytes()
    read.points.region = arrays["point_region"].astype(np.uint8).tobytes()
    return read


def _from_json(kind: type[Out], body: bytes) -> Out:
    return decode(kind, body, JSON, _MAX_ANSWER_BYTES)


def _listed(route: Route[Any, Any]) -> Callable[[pb.Nothing], HttpRequest]:
    return lambda _: request.get(route.path)


def _reading(
    route: Route[Any, Out], convert: Callable[[Out], object]
) -> Callable[[str, bytes], object]:
    def read(media_type: str, body: bytes) -> object:
        return convert(decode(route.response, body, media_type, _MAX_ANSWER_BYTES))

    return read


def _filled(route: Route[Any, Any], **names: str) -> str:
    return route.path.format(**{name: quote(text, safe="") for name, text in names.items()})


CALLS: Mapping[str, Call] = MappingProxyType(
    {
        "Grasp": Call(request.grasp, _read_grasp),
        "Explain": Call(_explain, _reading(EXPLANATION, answer.kept_explanation)),
        "ListTasks": Call(_listed(LIST_TASKS), _reading(LIST_TASKS, known.task_list)),
        "AddTask": Call(
            lambda asked: request.post(ADD_TASK.path, known.definition_fields(asked)),
            _reading(ADD_TASK, known.task),
        ),
        "DeleteTask": Call(_delete_task, _reading(DELETE_TASK, known.task)),
        "ListAffordances": Call(
            _listed(LIST_AFFORDANCES), _reading(LIST_AFFORDANCES, known.affordance_list)
        ),
        "ListGrippers": Call(_listed(LIST_GRIPPERS), _reading(LIST_GRIPPERS, known.gripper_list)),
        "Execute": Call(request.execute, _reading(EXECUTE, execution.execute_response)),
    }
)
"""By the method's name in proto/sparge.proto."""


def read_answer(call: Call, media_type: str, body: bytes) -> Any:
    """Return a call's answer from that of the gateway.

    Raises
    ------
    StageUnavailable
        The gateway answered what this server does not know: it is of another version.
    """
    try:
        return call.read(media_type, body)
    except (SpargeError, KeyError, ValueError) as error:
        told = error.message if isinstance(error, SpargeError) else str(error)
        raise StageUnavailable(f"the gateway answered nonsense: {told}", stage="gateway") from None
