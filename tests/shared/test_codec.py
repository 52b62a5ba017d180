"""Messages travel as JSON and npz without loss, and bad ones are named."""

from __future__ import annotations

import numpy as np
import orjson
import pytest

from shared.errors import InvalidInput, MalformedRequest, UnsupportedMediaType
from shared.schemas.grasp import Pose, SelectRequest
from shared.schemas.scene import PerceiveRequest, PerceiveResponse, SupportPlane
from shared.wire import JSON, NPZ, decode, encode

LIMIT = 10**7


@pytest.fixture
def response(rng: np.random.Generator) -> PerceiveResponse:
    return PerceiveResponse(
        object_points=rng.normal(size=(5, 3)),
        object_indices=np.arange(5, dtype=np.int32),
        obstacle_points=np.empty((0, 3)),
        plane=SupportPlane(normal=(0, 0, 1), offset=-0.8, inliers=9, residual_mm=1.5),
        up=(0, 0, 1),
        input_points=10,
        dropped={"invalid": 2, "support": 3},
        clusters=1,
    )


@pytest.mark.parametrize("media_type", [JSON, NPZ, "application/json; charset=utf-8"])
def test_round_trip(response: PerceiveResponse, media_type: str) -> None:
    base = media_type.split(";")[0]
    assert decode(PerceiveResponse, encode(response, base), media_type, LIMIT) == response


def test_messages_with_other_arrays_differ(response: PerceiveResponse) -> None:
    moved = response.model_copy(update={"object_points": response.object_points + 1e-9})
    assert moved != response


def test_arrays_are_read_only(response: PerceiveResponse) -> None:
    with pytest.raises(ValueError, match="read-only"):
        response.object_points[0, 0] = 1.0


def test_the_array_given_stays_writeable() -> None:
    given = np.zeros((1, 3))
    PerceiveRequest(points=given)
    given[0, 0] = 1.0


def test_integers_become_floats_and_float32_widens() -> None:
    for dtype in (np.int8, np.float32):
        points = PerceiveRequest(points=np.ones((2, 3), dtype=dtype)).points
        assert points is not None
        assert points.dtype == np.float64


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ({"points": [[1, 2]]}, r"\(1, 2\), allowed is \(N, 3\)"),
        ({"points": [[1, 2, 3], [4]]}, "not a regular array"),
        ({"points": "points"}, "dtype <U6"),
        ({"points": [[1, 2, "x"]]}, "dtype <U"),
        ({"points": [[None, 1, 2]]}, "dtype object"),
        ({"points": 7}, r"shape \(\)"),
        ({}, "either points or depth"),
        ({"points": [[1, 2, 3]], "depth": [[1]]}, "found both"),
        ({"depth": [[1]]}, "needs intrinsics"),
        ({"points": [[1, 2, 3]], "colour": 1}, "colour"),
        ({"points": [[1, 2, 3]], "seed": -1}, "seed"),
        ({"points": [[1, 2, 3]], "viewpoint": [0, 0]}, "viewpoint"),
    ],
)
def test_invalid_content_is_named(body: dict[str, object], told: str) -> None:
    with pytest.raises(InvalidInput, match=told):
        decode(PerceiveRequest, orjson.dumps(body), JSON, LIMIT)


@pytest.mark.parametrize(
    "body", [b"", b"{", b"[1]", b'{"points": [[NaN, 0, 1]]}', b"\xff\xfe", b"null"]
)
def test_what_is_not_json_is_malformed(body: bytes) -> None:
    with pytest.raises(MalformedRequest):
        decode(PerceiveRequest, body, JSON, LIMIT)


def test_deep_nesting_is_malformed_or_invalid() -> None:
    with pytest.raises((MalformedRequest, InvalidInput)):
        decode(PerceiveRequest, b'{"points": ' + b"[" * 5000 + b"]" * 5000 + b"}", JSON, LIMIT)


def test_other_media_types_are_named() -> None:
    with pytest.raises(UnsupportedMediaType, match="text/csv"):
        decode(PerceiveRequest, b"1,2,3", "text/csv", LIMIT)


def test_a_mask_takes_booleans_only() -> None:
    fields = {"points": np.zeros((2, 3)), "grasps": np.zeros((0, 9))}
    with pytest.raises(ValueError, match="allowed is bool"):
        SelectRequest(**fields, point_region=np.array([1, 0]))
    assert len(SelectRequest(**fields, point_region=[True, False]).point_region) == 2


@pytest.mark.parametrize("length", [0.0, 1e-9, 1e9])
def test_a_direction_points_somewhere(length: float) -> None:
    with pytest.raises(ValueError, match="must have a direction"):
        SupportPlane(normal=(0, 0, length), offset=0, inliers=1, residual_mm=1)
    with pytest.raises(ValueError, match="must have a direction"):
        Pose(position=(0, 0, 0), quaternion=(0, 0, 0, length))
