"""PointCloud2 as JSON: every layout that drivers have, and everything that may be wrong."""

from __future__ import annotations

import contextlib
import json
from typing import Any

import numpy as np
import pytest

from shared.errors import InvalidInput, PayloadTooLarge
from shared.schemas.point_cloud2 import PointCloud2, cloud_points, is_point_cloud2
from shared.wire.codec import validate
from tests.support.mutation import mutated
from tests.support.ros_clouds import cloud_message

LIMIT = 10**7
POINTS = np.arange(36, dtype=np.float64).reshape(12, 3) / 8  # exact in single precision


def points_of(message: dict[str, Any], limit: int = LIMIT) -> np.ndarray:
    assert is_point_cloud2(message)
    return cloud_points(validate(PointCloud2, message), limit)


@pytest.mark.parametrize("height", [1, 3])
@pytest.mark.parametrize("big_endian", [False, True])
@pytest.mark.parametrize("double", [False, True])
@pytest.mark.parametrize("padding", [0, 7])
@pytest.mark.parametrize("as_list", [False, True])
def test_every_layout_gives_the_points_row_by_row(
    height: int, big_endian: bool, double: bool, padding: int, as_list: bool
) -> None:
    message = cloud_message(
        POINTS,
        height=height,
        big_endian=big_endian,
        double=double,
        padding=padding,
        as_list=as_list,
    )
    found = points_of(json.loads(json.dumps(message)))
    np.testing.assert_array_equal(found, POINTS)
    assert found.dtype == np.float64


def test_no_return_stays_where_it_is() -> None:
    """Whatever `is_dense` says: the answer's arrays speak about every point."""
    seen = POINTS.copy()
    seen[[2, 5]] = np.nan
    for dense in (False, True):
        message = {**cloud_message(seen, height=3), "is_dense": dense}
        np.testing.assert_array_equal(points_of(message), seen)


def test_the_fields_may_come_in_any_order_and_with_others() -> None:
    message = cloud_message(POINTS)
    message["fields"] = message["fields"][::-1]
    message["fields"][0] = {"name": "ring", "offset": 16, "datatype": 4, "count": 2}
    np.testing.assert_array_equal(points_of(message), POINTS)
    for field in message["fields"]:
        field["count"] = 0 if field["name"] in "xyz" else 1  # as some drivers write it
    np.testing.assert_array_equal(points_of(message), POINTS)


def test_headers_of_both_generations() -> None:
    for stamp in ({"sec": 3, "nanosec": 4}, {"secs": 3, "nsecs": 4}):
        header = {"seq": 9, "stamp": stamp, "frame_id": "cam"}
        if "sec" in stamp:
            del header["seq"]
        cloud = validate(PointCloud2, {**cloud_message(POINTS), "header": header})
        assert cloud.header.stamp.model_dump() == {"sec": 3, "nanosec": 4}
    bare = cloud_message(POINTS)
    for name in ("header", "is_bigendian", "is_dense"):
        del bare[name]
    assert validate(PointCloud2, bare).header.frame_id == ""
    np.testing.assert_array_equal(points_of(bare), POINTS)


def test_an_empty_cloud_is_one() -> None:
    assert points_of(cloud_message(POINTS[:0])).shape == (0, 3)
    huge = {**cloud_message(POINTS[:0]), "point_step": 2**32 - 1, "height": 0}
    assert points_of(huge).shape == (0, 3)


def field(name: str, offset: int, datatype: int = 7, count: int = 1) -> dict[str, Any]:
    return {"name": name, "offset": offset, "datatype": datatype, "count": count}


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"data": "not base64!"}, "data: is a text, but not base64"),
        ({"data": [1, 2, 256]}, "data: must be a list of integers in 0..255"),
        ({"data": [0.5]}, "data: must be a list of integers"),
        ({"data": {"0": 1}}, "data"),
        ({"data": ""}, "data holds 0"),
        ({"width": 13}, "row_step"),
        ({"width": 11}, None),
        ({"height": 2}, "data holds 240"),
        ({"height": 0}, "data holds 240"),
        ({"height": 2**31}, "data holds 240"),
        ({"height": -1}, "height"),
        ({"height": 2**32}, "height"),
        ({"width": 2**31, "row_step": 2**32 - 1}, "row of 2147483648 points"),
        ({"row_step": 239}, "row_step is 239"),
        ({"row_step": 241}, "data holds 240"),
        ({"point_step": 19}, "ends at byte 20"),
        ({"point_step": 0}, "point_step is 0"),
        ({"fields": []}, "x, y, z are needed once each"),
        ({"fields": [field("x", 0), field("y", 4)]}, "needed once each"),
        ({"fields": [field(name, 0) for name in "xxyz"]}, "needed once each"),
        ({"fields": [field(name, 0, 5) for name in "xyz"]}, "FLOAT32"),
        ({"fields": [field(name, 0, 7, 2) for name in "xyz"]}, "found 2 of datatype 7"),
        ({"fields": [field(name, 0, 12) for name in "xyz"]}, "datatype 12; known are 1 to 11"),
        ({"fields": [field(name, 0, 0) for name in "xyz"]}, "datatype 0"),
        ({"fields": [field(name, 2**31) for name in "xyz"]}, "ends at byte"),
        ({"fields": [field("i", 0, 1, 2**32 - 1)]}, "ends at byte"),
        ({"fields": "xyz"}, "fields"),
        ({"is_bigendian": "perhaps"}, "is_bigendian"),
        ({"header": {"stamp": {"sec": 1, "nanosec": 10**9}}}, "nanosec"),
        ({"header": {"frame_id": "x" * 129}}, "frame_id"),
    ],
)
def test_what_is_wrong_is_named(change: dict[str, Any], told: str | None) -> None:
    message = {**cloud_message(POINTS), **change}
    if told is None:  # bytes behind the points of a row are padding
        np.testing.assert_array_equal(points_of(message), POINTS[:11])
        return
    with pytest.raises(InvalidInput, match=told):
        points_of(message)


def test_missing_fields_are_named() -> None:
    message = {"point_step": 12}
    with pytest.raises(InvalidInput, match=r"height: Field required.*width: Field required"):
        points_of(message)


def test_more_points_than_there_is_room_for() -> None:
    with pytest.raises(PayloadTooLarge):
        points_of(cloud_message(POINTS), limit=24 * len(POINTS) - 1)


def test_other_bodies_are_no_clouds() -> None:
    assert not is_point_cloud2({"points": [[0, 0, 1]], "task": "pouring"})
    assert not is_point_cloud2({})


def test_made_up_messages_are_read_or_refused(rng: np.random.Generator) -> None:
    read = 0
    for _ in range(600):
        message = mutated(cloud_message(POINTS, height=3, as_list=True), rng)
        if not isinstance(message, dict):
            continue
        with contextlib.suppress(InvalidInput, PayloadTooLarge):
            assert cloud_points(validate(PointCloud2, message), LIMIT).shape[1] == 3
            read += 1
    assert read > 10
