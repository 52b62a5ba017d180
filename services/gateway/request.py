"""POST /grasp: bodies of three kinds and parameters from three places -> one request."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any, Self

import orjson
from pydantic import Field, model_validator

from shared.errors import MalformedRequest
from shared.schemas.fields import TaskText, Vector3
from shared.schemas.primitive import EmsParameters, Method
from shared.schemas.scene import InputKind, View
from shared.schemas.task import RuleSet, Version
from shared.wire import Message
from shared.wire.codec import read_json_object, validate
from shared.wire.files import CloudFile, read_cloud_file

_ARRAYS = ("points", "depth", "intrinsics", "depth_scale")
_JSON_VALUES = ("viewpoint", "target", "recovery", "intrinsics", "depth_scale")


class GraspParameters(Message):
    """The contract's parameters of POST /grasp, each default written once."""

    task: TaskText
    reasoning: Version = "v2"
    rule_set: RuleSet | None = None
    """Which rules decide; without it, the backend's own."""
    input: InputKind = "scene"
    viewpoint: Vector3 = (0.0, 0.0, 0.0)
    target: Vector3 | None = None
    gripper: Annotated[str, Field(min_length=1, max_length=64)] = "panda"
    max_grasps: Annotated[int, Field(ge=0, le=100)] = 10
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0
    method: Method | None = None
    """How the object is cut into parts; without it, the backend's own method, or `ems`
    where `recovery` is given."""
    recovery: EmsParameters | None = None
    """Parameters of the method `ems`, instead of the backend's own."""
    explain: bool = True
    frame_id: Annotated[str, Field(min_length=1, max_length=128)] = "camera"

    @model_validator(mode="after")
    def _parameters_of_the_method(self) -> Self:
        if self.recovery is not None and self.method == "parts":
            raise ValueError("recovery holds parameters of the method ems, but method is parts")
        return self


class GraspRequest(Message):
    """A view and what is wanted of it."""

    parameters: GraspParameters
    view: View


def from_json(body: bytes, query: Mapping[str, str]) -> GraspRequest:
    """Read `{"points": [[x, y, z], ...], parameters...}`."""
    fields = read_json_object(body)
    arrays = {name: fields.pop(name) for name in _ARRAYS if name in fields}
    return _request(arrays, {**fields, **_typed(query)})


def from_npz(body: bytes, query: Mapping[str, str], max_unpacked_bytes: int) -> GraspRequest:
    """Read the arrays `points`, or `depth`, `intrinsics`, `depth_scale`; others are ignored."""
    held = read_cloud_file("body.npz", body, max_unpacked_bytes=max_unpacked_bytes)
    return _request(held.fields(), _typed(query))


def from_form(
    filename: str,
    body: bytes,
    form: Mapping[str, str],
    query: Mapping[str, str],
    read: Callable[..., CloudFile],
) -> GraspRequest:
    """Read an uploaded file; a depth image may have `intrinsics` and `depth_scale` beside it.

    `read` is called as `FileReader.read`.
    """
    fields = _typed({**form, **query})
    held = read(
        filename,
        body,
        intrinsics=fields.pop("intrinsics", None),
        depth_scale=fields.pop("depth_scale", None),
    )
    return _request(held.fields(), fields)


def _request(arrays: dict[str, Any], fields: dict[str, Any]) -> GraspRequest:
    parameters = validate(GraspParameters, fields)
    view = validate(View, {**arrays, "viewpoint": parameters.viewpoint})
    return GraspRequest(parameters=parameters, view=view)


def _typed(texts: Mapping[str, str]) -> dict[str, Any]:
    """Turn query and form texts into values: numbers, lists and objects are JSON."""
    values: dict[str, Any] = dict(texts)
    for name in _JSON_VALUES:
        if name in values:
            try:
                values[name] = orjson.loads(values[name])
            except orjson.JSONDecodeError:
                example = '{"eps": 0.02, ...}' if name == "recovery" else "[0, 0, 0]"
                raise MalformedRequest(
                    f"{name} must be JSON, as in {example}; found {values[name][:80]!r}",
                    field=name,
                ) from None
    return values
