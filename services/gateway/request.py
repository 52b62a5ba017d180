"""POST /grasp: bodies of three kinds and parameters from three places -> one request."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any, Self

import orjson
from pydantic import Field, model_validator

from shared.errors import InvalidInput, MalformedRequest
from shared.schemas.fields import TaskText, Vector3
from shared.schemas.formats import Format
from shared.schemas.point_cloud2 import PointCloud2, cloud_points, is_point_cloud2
from shared.schemas.primitive import EmsParameters, Method
from shared.schemas.rehearsal import Rehearsing
from shared.schemas.rejection import Examples
from shared.schemas.ros import RosTime
from shared.schemas.scene import InputKind, View
from shared.schemas.task import RuleSet, Version
from shared.schemas.urdf import TCP, RosName
from shared.wire import Message
from shared.wire.codec import read_json_object, validate
from shared.wire.files import DEFAULT_MAX_UNPACKED_BYTES, CloudFile, read_cloud_file

_ARRAYS = ("points", "depth", "intrinsics", "depth_scale")
_JSON_VALUES = ("viewpoint", "target", "recovery", "stamp", "intrinsics", "depth_scale")
_EXAMPLES = {"recovery": '{"eps": 0.02, ...}', "stamp": '{"sec": 12, "nanosec": 0}'}


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
    rehearsal: Rehearsing | None = None
    """Whether grasps are tried in simulation before they are answered; without it, the backend's
    own way."""
    rejected: Examples = 0
    """So many hand poses that were considered and left out are in the answer, with the reason."""
    frame_id: Annotated[str, Field(min_length=1, max_length=128)] = "camera"
    format: Format = "sparge"
    """Which tool's format the answer is in."""
    pose_of: RosName | None = None
    """Of `moveit` and `pose_array`: whose pose a grasp is, `tcp` or a link of the gripper's.
    Without it, the link that MoveIt expects, and the tool centre point."""
    stamp: RosTime | None = None
    """When the view was taken, for the headers of `moveit` and `pose_array`; without it, that of
    the PointCloud2, or 0."""

    @model_validator(mode="after")
    def _parameters_of_the_method(self) -> Self:
        if self.recovery is not None and self.method == "parts":
            raise ValueError("recovery holds parameters of the method ems, but method is parts")
        return self

    @model_validator(mode="after")
    def _rejected_in_the_format(self) -> Self:
        if self.rejected and self.format != "sparge":
            raise ValueError(f"format={self.format} has no place for rejected hand poses")
        return self

    @model_validator(mode="after")
    def _pose_of_the_format(self) -> Self:
        if self.pose_of not in (None, TCP) and self.format in ("sparge", "graspnet"):
            raise ValueError(
                f"format={self.format} gives poses of the tool centre point; pose_of is for "
                "format=moveit and format=pose_array"
            )
        return self


class GraspRequest(Message):
    """A view and what is wanted of it."""

    parameters: GraspParameters
    view: View


def from_json(
    body: bytes,
    query: Mapping[str, str],
    max_unpacked_bytes: int = DEFAULT_MAX_UNPACKED_BYTES,
) -> GraspRequest:
    """Read `{"points": [[x, y, z], ...], parameters...}`, or a PointCloud2 beside parameters."""
    fields = read_json_object(body)
    if is_point_cloud2(fields):
        fields = _from_point_cloud2(fields, max_unpacked_bytes)
    arrays = {name: fields.pop(name) for name in _ARRAYS if name in fields}
    return _request(arrays, {**fields, **_typed(query)})


def _from_point_cloud2(fields: dict[str, Any], max_bytes: int) -> dict[str, Any]:
    """Return points and parameters in place of a message; frame and time are the header's."""
    both = [name for name in _ARRAYS if name in fields]
    if both:
        raise InvalidInput(
            f"the body is a PointCloud2 and holds {', '.join(both)} as well; give one of them",
            field=both[0],
        )
    held = {name: fields[name] for name in PointCloud2.model_fields if name in fields}
    cloud = validate(PointCloud2, held)
    said: dict[str, Any] = {"stamp": cloud.header.stamp.model_dump()}
    if cloud.header.frame_id:
        said["frame_id"] = cloud.header.frame_id
    parameters = {name: value for name, value in fields.items() if name not in held}
    return {**said, **parameters, "points": cloud_points(cloud, max_bytes)}


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


def from_tensors(arrays: dict[str, Any], parameters: Mapping[str, Any]) -> GraspRequest:
    """Join arrays and parameters, texts where a query has them or values of their own type."""
    return _request(arrays, _typed(parameters))


def _request(arrays: dict[str, Any], fields: dict[str, Any]) -> GraspRequest:
    parameters = validate(GraspParameters, fields)
    view = validate(View, {**arrays, "viewpoint": parameters.viewpoint})
    return GraspRequest(parameters=parameters, view=view)


def _typed(texts: Mapping[str, Any]) -> dict[str, Any]:
    """Turn query and form texts into values: numbers, lists and objects are JSON."""
    values: dict[str, Any] = dict(texts)
    for name in _JSON_VALUES:
        if isinstance(values.get(name), str):
            try:
                values[name] = orjson.loads(values[name])
            except orjson.JSONDecodeError:
                example = _EXAMPLES.get(name, "[0, 0, 0]")
                raise MalformedRequest(
                    f"{name} must be JSON, as in {example}; found {values[name][:80]!r}",
                    field=name,
                ) from None
    return values
