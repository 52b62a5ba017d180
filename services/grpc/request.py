"""A call's message -> the request of the HTTP interface that asks the same."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import orjson

from services.grpc import geometry
from services.grpc.enums import text
from services.grpc.generated import sparge_pb2 as pb
from shared.errors import InvalidInput
from shared.wire import JSON, NPZ
from shared.wire.codec import ENVELOPE
from shared.wire.npz import write_npz

_PLAIN = ("gripper", "max_grasps", "seed", "frame_id", "rejected")
_VECTORS = ("viewpoint", "target")
_CHOICES = {
    "reasoning": pb.Reasoning,
    "rule_set": pb.RuleSet,
    "input": pb.Input,
    "method": pb.Method,
    "rehearsal": pb.Rehearsing,
}


@dataclass(frozen=True)
class HttpRequest:
    """What an HTTP client sends; the fields are those of `httpx.AsyncClient.request`."""

    method: str
    url: str
    accept: str = JSON
    params: dict[str, str] = field(default_factory=dict)
    content_type: str | None = None
    content: bytes | None = None
    files: dict[str, tuple[str, bytes]] | None = None


def get(url: str) -> HttpRequest:
    """Return the request that reads `url`."""
    return HttpRequest("GET", url)


def delete(url: str) -> HttpRequest:
    """Return the request that deletes what is at `url`."""
    return HttpRequest("DELETE", url)


def post(url: str, fields: dict[str, Any]) -> HttpRequest:
    """Return the request that sends `fields` as JSON."""
    return HttpRequest("POST", url, content_type=JSON, content=orjson.dumps(fields))


def grasp(asked: pb.GraspRequest) -> HttpRequest:
    """Return POST /grasp; a call that wants per-point labels asks for npz.

    Raises
    ------
    InvalidInput
        A cloud, an image or a matrix has not the size that it should, or an enumeration
        has no such value. Everything else is judged by the gateway.
    """
    accept = NPZ if asked.per_point else JSON
    params = grasp_parameters(asked)
    match asked.WhichOneof("view"):
        case "file":
            camera = geometry.camera(asked.file, "file")
            params |= {name: _json(np.asarray(value).tolist()) for name, value in camera.items()}
            upload = {"file": (asked.file.name, asked.file.content)}
            return HttpRequest("POST", "/grasp", accept, params, files=upload)
        case "points":
            arrays = {"points": geometry.points(asked.points, "points")}
        case "depth":
            arrays = geometry.depth(asked.depth)
        case _:  # the gateway says what is missing
            return HttpRequest("POST", "/grasp", accept, params, JSON, b"{}")
    return HttpRequest("POST", "/grasp", accept, params, NPZ, write_npz(arrays))


def grasp_parameters(asked: pb.GraspRequest) -> dict[str, str]:
    """Return the parameters that are set, as a query holds them; the gateway has the defaults."""
    given = {"task": asked.task} if asked.task else {}
    given |= {name: str(getattr(asked, name)) for name in _PLAIN if asked.HasField(name)}
    for name in _VECTORS:
        if asked.HasField(name):
            given[name] = _json(geometry.vector_fields(getattr(asked, name)))
    for name, kind in _CHOICES.items():
        if (chosen := text(kind, getattr(asked, name), name)) is not None:
            given[name] = chosen
    if asked.HasField("recovery"):
        given["recovery"] = _json({each.name: value for each, value in asked.recovery.ListFields()})
    if asked.HasField("explain"):
        given["explain"] = str(asked.explain).lower()
    return given


def execute(asked: pb.ExecuteRequest) -> HttpRequest:
    """Return POST /execute, with the mesh as arrays.

    Raises
    ------
    InvalidInput
        As in `grasp`.
    """
    fields: dict[str, Any] = {
        name: getattr(asked, name)
        for name in ("width", "mass", "gripper", "strict", "brisk", "seed", "animate", "motion")
        if asked.HasField(name)
    }
    fields |= {
        name: geometry.pose_fields(getattr(asked, name))
        for name in ("pose", "object_pose")
        if asked.HasField(name)
    }
    fields["primitives"] = [list(each.parameters) for each in asked.primitives]
    if asked.HasField("plane"):
        fields["plane"] = geometry.plane_fields(asked.plane)
    fields |= {
        name: geometry.vector_fields(getattr(asked, name))
        for name in ("up", "heading", "viewpoint")
        if asked.HasField(name)
    }
    if (actor := text(pb.Actor, asked.actor, "actor")) is not None:
        fields["actor"] = actor
    if (believed := text(pb.Believed, asked.believed, "believed")) is not None:
        fields["believed"] = believed
    message = np.frombuffer(_json(fields).encode(), dtype=np.uint8)
    content = write_npz({**_mesh(asked), ENVELOPE: message})
    return HttpRequest("POST", "/execute", content_type=NPZ, accept=NPZ, content=content)


def _mesh(asked: pb.ExecuteRequest) -> dict[str, Any]:
    arrays: dict[str, Any] = {}
    for name in ("vertices", "points"):
        if asked.HasField(name):
            arrays[name] = geometry.points(getattr(asked, name), name)
    if asked.HasField("faces"):
        corners = np.array(asked.faces.indices, dtype=np.int32)
        if corners.size % 3:
            raise InvalidInput(
                f"faces has {corners.size} indices, allowed are whole rows of 3",
                field="faces",
                found=corners.size,
                allowed=3,
            )
        arrays["faces"] = corners.reshape(-1, 3)
    if asked.highlight:
        arrays["highlight"] = np.array(asked.highlight, dtype=np.bool_)
    return arrays


def _json(value: object) -> str:
    """Return JSON as Python writes it: numbers that are not finite stay to be refused."""
    return json.dumps(value)
