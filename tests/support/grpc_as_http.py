"""The HTTP interface, spoken over gRPC: so that the same tests hold both to the same answers."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

import grpc
import httpx
import numpy as np
from google.protobuf.json_format import MessageToDict
from grpc_health.v1 import health_pb2, health_pb2_grpc

from services.grpc.enums import number
from services.grpc.generated import sparge_pb2 as pb
from services.grpc.status import ERROR_TRAILER, RETRY_AFTER_TRAILER, STATUS_CODES
from shared.errors import MalformedRequest, PayloadTooLarge, SpargeError
from shared.wire import NPZ
from shared.wire.npz import read_npz, write_npz
from tests.support.grpc_calls import call

Json = dict[str, Any]
_ENUMS = {
    "reasoning": pb.Reasoning,
    "rule_set": pb.RuleSet,
    "input": pb.Input,
    "method": pb.Method,
    "rehearsal": pb.Rehearsing,
}
_TYPES = {"float32": "<f4", "float64": "<f8", "uint16": "<u2"}


class GrpcAsHttp:
    """Answers `request` as a client of the gateway does, by calls.

    Parameters
    ----------
    channel : grpc.Channel
        To the gRPC server.
    """

    def __init__(self, channel: grpc.Channel) -> None:
        self._channel = channel

    def request(self, method: str, path: str, **options: Any) -> httpx.Response:
        """As `httpx.Client.request`, for the endpoints that are calls as well."""
        match method, path.strip("/").split("/"):
            case "POST", ["grasp"]:
                return self._grasp(**options)
            case "GET", ["grasp", name, "explanation"]:
                return self._asked("Explain", pb.RequestName(request_id=name))
            case "GET", ["tasks"]:
                return self._asked("ListTasks", pb.Nothing())
            case "POST", ["tasks"]:
                return self._asked("AddTask", pb.TaskDefinition(**options["json"]))
            case "DELETE", ["tasks", name]:
                return self._asked("DeleteTask", pb.TaskName(name=name))
            case "GET", ["affordances"]:
                return self._asked("ListAffordances", pb.Nothing())
            case "GET", ["grippers"]:
                return self._asked("ListGrippers", pb.Nothing())
            case "POST", ["execute"]:
                return self._asked("Execute", execute_request(options["json"]))
            case "GET", ["health", "ready"]:
                stub = health_pb2_grpc.HealthStub(self._channel)
                said = stub.Check(health_pb2.HealthCheckRequest())
                ready = said.status == health_pb2.HealthCheckResponse.SERVING
                return httpx.Response(200 if ready else 503)
        raise NotImplementedError(f"{method} {path}")

    def _grasp(
        self,
        params: Mapping[str, str] | None = None,
        content: bytes = b"",
        headers: Mapping[str, str] | None = None,
        json: Json | None = None,
        data: Mapping[str, str] | None = None,
        files: Mapping[str, tuple[str, bytes]] | None = None,
    ) -> httpx.Response:
        fields: Json = {**(data or {}), **(params or {}), **(json or {})}
        npz = (headers or {}).get("Accept") == NPZ
        asked = pb.GraspRequest(per_point=npz)
        if files is not None:
            name, body = files["file"]
            camera = {key: _value(fields.pop(key)) for key in ("depth_scale",) if key in fields}
            matrix = np.ravel(_value(fields.pop("intrinsics", "[]")))
            asked.file.MergeFrom(pb.CloudFile(name=name, content=body, intrinsics=matrix, **camera))
        elif json is not None:
            rows = np.asarray(fields.pop("points"), dtype="<f8")
            asked.points.float64 = rows.tobytes()
        else:
            _fill_view(asked, content)
        _fill_parameters(asked, fields)
        return self._asked("Grasp", asked, _as_npz if npz else None)

    def _asked(
        self, name: str, message: Any, write: Callable[[Any], bytes] | None = None
    ) -> httpx.Response:
        try:
            answer, _ = call(self._channel, name, message)
        except grpc.RpcError as error:
            return _error(error)
        if write is not None:
            return httpx.Response(200, content=write(answer), headers={"Content-Type": NPZ})
        return httpx.Response(200, json=plain(answer))


ROW_LENGTHS = {"motion_object": 7, "motion_hand": 7, "motion_joints": 7}
"""Fields of ExecuteResponse that are rows of so many numbers."""
ONLY_WHERE_ASKED_FOR = {
    "sparge.v1.Grasp.rehearsed",
    "sparge.v1.GraspAnswer.rehearsal",
    "sparge.v1.GraspAnswer.rejected",
    *(
        f"sparge.v1.ExecuteResponse.motion_{name}"
        for name in ("times", "object", "hand", "opening", "phases", "joints", "base")
    ),
}
"""Fields that HTTP leaves out where they are empty."""


def plain(message: Any) -> Json:
    """Return the JSON of the HTTP interface for a message: every field, None where not set."""
    fields: Json = {}
    for each in message.DESCRIPTOR.fields:
        if each.full_name == "sparge.v1.GraspAnswer.points":
            continue
        value = getattr(message, each.name)
        missing = not (message.HasField(each.name) if each.has_presence else value)
        if each.full_name in ONLY_WHERE_ASKED_FOR and missing:
            continue
        if each.name in ROW_LENGTHS:
            fields[each.name] = np.reshape(value, (-1, ROW_LENGTHS[each.name])).tolist()
        elif each.is_repeated:
            entries = each.message_type and each.message_type.GetOptions().map_entry
            fields[each.name] = dict(value) if entries else [_plain(each, one) for one in value]
        elif each.has_presence and missing:
            fields[each.name] = None
        else:
            fields[each.name] = _plain(each, value)
    return fields


def _plain(field: Any, value: Any) -> Any:
    if field.enum_type is not None:
        name = field.enum_type.values_by_number[value].name
        prefix = field.enum_type.values_by_number[0].name.removesuffix("UNSPECIFIED")
        return name.removeprefix(prefix).lower()
    if field.message_type is None:
        return value
    match field.message_type.name:
        case "Vector3":
            return [value.x, value.y, value.z]
        case "Quaternion":
            return [value.x, value.y, value.z, value.w]
        case "Gripper":
            kind = value.WhichOneof("kind")
            return {"kind": kind, **plain(getattr(value, kind))}
    return plain(value)


def execute_request(fields: Json) -> pb.ExecuteRequest:
    """Return the message for a JSON body of POST /execute without a mesh."""
    given = dict(fields)
    asked = pb.ExecuteRequest(pose=_pose(given.pop("pose")), width=given.pop("width"))
    asked.primitives.extend(pb.Superquadric(parameters=each) for each in given.pop("primitives"))
    if (plane := given.pop("plane", None)) is not None:
        asked.plane.MergeFrom(pb.SupportPlane(**{**plane, "normal": _vector(plane["normal"])}))
    for name in ("up", "heading", "viewpoint"):
        if name in given:
            getattr(asked, name).MergeFrom(_vector(given.pop(name)))
    if "actor" in given:
        asked.actor = number(pb.Actor, given.pop("actor"))
    if "believed" in given:
        asked.believed = number(pb.Believed, given.pop("believed"))
    for name, value in given.items():
        setattr(asked, name, value)
    return asked


def _pose(fields: Json) -> pb.Pose:
    x, y, z, w = fields["quaternion"]
    return pb.Pose(
        position=_vector(fields["position"]), quaternion=pb.Quaternion(x=x, y=y, z=z, w=w)
    )


def _vector(values: Any) -> pb.Vector3:
    x, y, z = values
    return pb.Vector3(x=x, y=y, z=z)


def _value(text: Any) -> Any:
    return json.loads(text) if isinstance(text, str) else text


def _fill_view(asked: pb.GraspRequest, content: bytes) -> None:
    """Send arrays as they are where gRPC has a type for them; what has none goes as a file."""
    try:
        arrays = read_npz(content, 10**8)
    except (MalformedRequest, PayloadTooLarge):
        arrays = {}
    kinds = {np.dtype(text): name for name, text in _TYPES.items()}
    rows, depth = arrays.get("points"), arrays.get("depth")
    if rows is not None and rows.shape[1:] == (3,) and kinds.get(rows.dtype, "uint16") != "uint16":
        setattr(asked.points, kinds[rows.dtype], rows.tobytes())
    elif depth is not None and depth.dtype in kinds:
        asked.depth.height, asked.depth.width = depth.shape
        setattr(asked.depth, kinds[depth.dtype], depth.tobytes())
        asked.depth.intrinsics.extend(arrays["intrinsics"].ravel())
        asked.depth.depth_scale = float(arrays["depth_scale"])
    else:
        asked.file.MergeFrom(pb.CloudFile(name="body.npz", content=content))


def _fill_parameters(asked: pb.GraspRequest, fields: Json) -> None:
    for name, value in fields.items():
        if name in _ENUMS:
            setattr(asked, name, number(_ENUMS[name], value))
        elif name in ("viewpoint", "target"):
            getattr(asked, name).MergeFrom(_vector(_value(value)))
        elif name == "recovery":
            asked.recovery.MergeFrom(pb.EmsParameters(**_value(value)))
        elif name in ("max_grasps", "seed", "explain", "rejected"):
            setattr(asked, name, _value(value))
        else:
            setattr(asked, name, value)


def _as_npz(answer: pb.GraspAnswer) -> bytes:
    held = [each.parameters for each in answer.primitives]
    rows = [
        [
            *_plain_vector(each.pose.position),
            *_plain_vector(each.pose.quaternion),
            each.width,
            each.score,
        ]
        for each in answer.grasps
    ]
    return write_npz(
        {
            "point_primitive": np.frombuffer(answer.points.primitive, dtype="<i2"),
            "point_region": np.frombuffer(answer.points.region, dtype=np.uint8).astype(np.bool_),
            "primitives": np.array(held, dtype=np.float64).reshape(-1, 12),
            "grasps": np.array(rows, dtype=np.float64).reshape(-1, 9),
            "report": np.frombuffer(json.dumps(plain(answer)).encode(), dtype=np.uint8),
        }
    )


def _plain_vector(value: Any) -> list[float]:
    return [getattr(value, each.name) for each in value.DESCRIPTOR.fields]


def _error(error: Any) -> httpx.Response:
    trailers = dict(error.trailing_metadata() or ())
    if ERROR_TRAILER not in trailers:  # gRPC itself refused the message for its size
        assert error.code() is grpc.StatusCode.RESOURCE_EXHAUSTED, error
        told = PayloadTooLarge(error.details())
        return httpx.Response(told.status, json=told.envelope(""))
    said = pb.Error.FromString(trailers[ERROR_TRAILER])
    status = SpargeError.by_code[said.code].status
    assert error.code() is STATUS_CODES[status]
    envelope = {
        "code": said.code,
        "message": said.message,
        "details": MessageToDict(said.details),
        "request_id": said.request_id,
    }
    headers = {"X-Request-ID": trailers["x-request-id"]}
    if RETRY_AFTER_TRAILER in trailers:
        headers["Retry-After"] = trailers[RETRY_AFTER_TRAILER]
    return httpx.Response(status, json={"error": envelope}, headers=headers)
