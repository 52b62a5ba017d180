"""The answer to POST /grasp, against the contract's tables."""

from __future__ import annotations

import io
import json
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from PIL import Image

from shared.geometry.points import points_from_depth
from shared.schemas.primitive import PRESETS
from shared.wire.npz import read_npz, write_npz
from tests.support.samples import sample_path, sample_view
from tests.support.serving import Client

NPZ = "application/x-npz"
BOTTLE = sample_path("bottle").read_bytes()


def answer(backend: Client, body: bytes = BOTTLE, **query: str) -> dict[str, Any]:
    response = backend.request(
        "POST",
        "/grasp",
        params={"task": "pouring", **query},
        content=body,
        headers={"Content-Type": NPZ},
    )
    assert response.status_code == 200, response.text
    found: dict[str, Any] = response.json()
    return found


def arrays(backend: Client, body: bytes = BOTTLE, **query: str) -> dict[str, np.ndarray]:
    response = backend.request(
        "POST",
        "/grasp",
        params={"task": "pouring", **query},
        content=body,
        headers={"Content-Type": NPZ, "Accept": NPZ},
    )
    assert response.status_code == 200, response.text
    assert response.headers["content-type"] == NPZ
    return read_npz(response.content, 10**8)


def timeless(found: dict[str, Any]) -> dict[str, Any]:
    return {key: found[key] for key in found if key not in ("request_id", "timings_ms")}


def bottle_points() -> np.ndarray:
    view = sample_view("bottle")
    return points_from_depth(view["depth"], view["intrinsics"], view["depth_scale"])


def test_the_json_answer_holds_what_the_contract_lists(backend: Client) -> None:
    found = answer(backend)
    assert found["found"] is True
    assert found["reason"] is None
    assert found["frame_id"] == "camera"
    assert found["region"]["affordance"] in ("wrap_grasp", "grasp")
    assert 0 <= found["region"]["confidence"] <= 1
    for primitive in found["primitives"]:
        assert len(primitive["parameters"]) == 12
        extents = [2 * semi_axis for semi_axis in primitive["parameters"][2:5]]
        assert primitive["full_extents"] == pytest.approx(extents)
        assert primitive["shape_class"] in ("cuboid", "cylinder", "sphere")
    stages = {"perception", "primitive_recovery", "reasoning", "grasp_proposal", "matching"}
    assert stages | {"parsing", "checks", "total"} == set(found["timings_ms"])
    assert found["explanation"]["text"]
    assert found["explanation"]["rules"]


def test_grasps_come_with_pregrasp_and_retreat(backend: Client) -> None:
    found = answer(backend)
    assert 0 < len(found["grasps"]) <= 10
    up = np.array(found["scene"]["up"])
    for grasp in found["grasps"]:
        position = np.array(grasp["pose"]["position"])
        assert np.linalg.norm(grasp["pose"]["quaternion"]) == pytest.approx(1)
        assert np.linalg.norm(position - grasp["pregrasp"]["position"]) == pytest.approx(0.10)
        np.testing.assert_allclose(grasp["retreat"]["position"], position + 0.10 * up)
        assert 0 < grasp["width"] <= 0.08
    scores = [grasp["score"] for grasp in found["grasps"]]
    assert scores == sorted(scores, reverse=True)


def test_the_npz_answer_speaks_about_every_input_point(backend: Client) -> None:
    held = arrays(backend)
    report = json.loads(held["report"].tobytes())
    assert timeless(report) == timeless(answer(backend))
    pixels = 480 * 640
    for name, dtype in (("point_primitive", "int16"), ("point_region", "bool")):
        assert held[name].shape == (pixels,)
        assert str(held[name].dtype) == dtype
    assert held["primitives"].shape == (len(report["primitives"]), 12)
    assert held["grasps"].shape == (len(report["grasps"]), 9)
    in_region = np.isin(held["point_primitive"], report["region"]["primitive_ids"])
    np.testing.assert_array_equal(held["point_region"], in_region)
    assert (held["point_primitive"] >= 0).sum() == report["scene"]["object_points"]


def test_every_grasp_is_in_the_region(backend: Client) -> None:
    held = arrays(backend)
    on_object = held["point_primitive"] >= 0
    points, region = bottle_points()[on_object], held["point_region"][on_object]
    for row in held["grasps"]:
        assert region[np.argmin(np.linalg.norm(points - row[:3], axis=1))]


def test_the_same_request_gives_the_same_answer(backend: Client) -> None:
    assert timeless(answer(backend, seed="5")) == timeless(answer(backend, seed="5"))


def test_points_and_depth_agree(backend: Client) -> None:
    by_depth = answer(backend)
    by_points = answer(backend, write_npz({"points": bottle_points()}))
    assert by_points["region"]["primitive_ids"] == by_depth["region"]["primitive_ids"]
    assert by_points["scene"]["object_points"] == by_depth["scene"]["object_points"]


def test_files_and_json_give_the_same_region(backend: Client) -> None:
    view = sample_view("bottle")
    stream = io.BytesIO()
    Image.fromarray(view["depth"]).save(stream, "PNG")
    by_png = backend.request(
        "POST",
        "/grasp",
        data={
            "task": "pouring",
            "intrinsics": json.dumps(view["intrinsics"].tolist()),
            "depth_scale": str(view["depth_scale"]),
        },
        files={"file": ("depth.png", stream.getvalue())},
    )
    assert by_png.status_code == 200, by_png.text
    assert timeless(by_png.json()) == timeless(answer(backend))
    held = arrays(backend)
    points = bottle_points()[held["point_primitive"] >= 0]
    by_json = backend.request(
        "POST",
        "/grasp",
        json={"points": points.tolist(), "task": "pouring", "input": "object", "frame_id": "map"},
    )
    assert by_json.status_code == 200, by_json.text
    assert by_json.json()["frame_id"] == "map"
    assert by_json.json()["scene"]["plane"] is None


def test_not_found_says_why_and_what_came_closest(backend: Client) -> None:
    found = answer(backend, task="turning", reasoning="v1")
    assert found["found"] is False
    assert found["region"] is None
    assert found["grasps"] == []
    assert found["reason"]["code"] == "no_part_matches"
    miss = found["explanation"]["nearest_miss"]
    assert any(not condition["holds"] for condition in miss["conditions"])
    assert found["reason"]["message"]


def test_only_the_region_can_be_asked_for(backend: Client) -> None:
    found = answer(backend, max_grasps="0")
    assert found["found"] is True
    assert found["reason"]["code"] == "no_grasps_requested"


def test_without_explanation(backend: Client) -> None:
    assert answer(backend, explain="false")["explanation"] is None


def test_a_new_task_is_known_to_the_next_request(backend: Client) -> None:
    watering = {"name": "watering", "requires": ["contain"], "grasp": ["wrap_grasp"]}
    added = backend.request("POST", "/tasks", json=watering)
    assert added.status_code == 200, added.text
    try:
        found = answer(backend, task="watering")
        assert found["region"] == answer(backend)["region"]
    finally:
        assert backend.request("DELETE", "/tasks/watering").status_code == 200
    assert "watering" not in backend.request("GET", "/tasks").text


def test_an_answer_can_be_executed(backend: Client) -> None:
    found = answer(backend, task="handover")
    grasp = found["grasps"][0]
    done = backend.request(
        "POST",
        "/execute",
        json={
            "pose": grasp["pose"],
            "width": grasp["width"],
            "primitives": [each["parameters"] for each in found["primitives"]],
            "plane": found["scene"]["plane"],
        },
    )
    assert done.status_code == 200, done.text
    assert done.json()["message"]
    assert done.json()["success"] is (done.json()["outcome"] == "lifted")


def test_requests_side_by_side_do_not_mix(backend: Client) -> None:
    questions = [{"task": task, "seed": seed} for task in ("pouring", "handover") for seed in "12"]
    alone = [timeless(answer(backend, BOTTLE, **each)) for each in questions]
    with ThreadPoolExecutor(8) as pool:
        together = list(pool.map(lambda each: answer(backend, BOTTLE, **each), questions * 3))
    assert [timeless(each) for each in together] == alone * 3


def test_parameters_of_the_recovery_reach_it(backend: Client) -> None:
    hammer = sample_path("hammer").read_bytes()
    plain = answer(backend, hammer, method="ems")
    same = answer(backend, hammer, recovery=PRESETS["simulation"].model_dump_json())
    assert timeless(same) == timeless(plain)
    assert len(plain["primitives"]) > 1
    alone = PRESETS["simulation"].model_copy(update={"min_points": 100_000})
    assert len(answer(backend, hammer, recovery=alone.model_dump_json())["primitives"]) == 1


def test_parameters_of_ems_and_the_method_parts_contradict_each_other(backend: Client) -> None:
    response = backend.request(
        "POST",
        "/grasp",
        params={
            "task": "pouring",
            "method": "parts",
            "recovery": PRESETS["simulation"].model_dump_json(),
        },
        content=BOTTLE,
        headers={"Content-Type": NPZ},
    )
    assert response.status_code == 422
    assert "method is parts" in response.json()["error"]["message"]


def test_the_answer_says_how_the_object_was_cut(backend: Client) -> None:
    for method in ("parts", "ems"):
        assert answer(backend, method=method)["scene"]["method"] == method


def test_a_request_may_choose_the_rules(backend: Client) -> None:
    for rule_set in ("thesis", "default"):
        chosen = answer(backend, rule_set=rule_set)
        assert chosen["rule_set"] == rule_set
        rules = [trace["rule"] for trace in chosen["explanation"]["rules"]]
        assert any(rule.startswith(f"{rule_set}/") for rule in rules), rules
    assert answer(backend)["rule_set"] == "default"
    assert answer(backend)["found"]


def test_the_explanation_can_be_asked_for_afterwards(backend: Client) -> None:
    given = answer(backend)
    kept = backend.request("GET", f"/grasp/{given['request_id']}/explanation")
    assert kept.status_code == 200
    for field in ("request_id", "task", "found", "region", "explanation"):
        assert kept.json()[field] == given[field]
    unknown = backend.request("GET", "/grasp/nobody/explanation")
    assert unknown.status_code == 404
    assert unknown.json()["error"]["code"] == "not_found"
    silent = answer(backend, explain="false")
    missing = backend.request("GET", f"/grasp/{silent['request_id']}/explanation")
    assert missing.status_code == 404
