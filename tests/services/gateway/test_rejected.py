"""`rejected`: the hand poses that an answer leaves out, with the reason."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from shared.schemas.rejection import WHY_REJECTED
from tests.support.samples import sample_path
from tests.support.serving import Client

NPZ = {"Content-Type": "application/x-npz"}
HAMMER = sample_path("hammer").read_bytes()


def ask(backend: Client, **query: str) -> dict[str, Any]:
    asked = {"task": "hammering", **query}
    response = backend.request("POST", "/grasp", params=asked, content=HAMMER, headers=NPZ)
    assert response.status_code == 200, response.text
    found: dict[str, Any] = response.json()
    return {key: value for key, value in found.items() if key not in ("request_id", "timings_ms")}


def test_rejected_hand_poses_come_beside_an_answer_that_stays_the_same(backend: Client) -> None:
    alone, beside = ask(backend), ask(backend, rejected="60")
    rejected = beside.pop("rejected")
    assert beside == alone
    assert ask(backend, rejected="0") == alone
    assert len(rejected) == 60
    codes = [each["reason"]["code"] for each in rejected]
    for each in rejected:
        assert each["reason"]["message"] == WHY_REJECTED[each["reason"]["code"]]
        assert np.linalg.norm(each["pose"]["quaternion"]) == pytest.approx(1)
        assert each["width"] >= 0
    assert {"beyond_max_grasps", "too_wide", "better_grasp_nearby"} <= set(codes)
    assert all(codes.count(code) < 20 for code in codes)
    accepted = {tuple(each["pose"]["position"]) for each in alone["grasps"]}
    assert not accepted & {tuple(each["pose"]["position"]) for each in rejected}


def test_they_are_in_the_frame_of_the_grasps(backend: Client) -> None:
    found = ask(backend, rejected="100", max_grasps="100")
    grasps = np.array([each["pose"]["position"] for each in found["grasps"]])
    rejected = np.array([each["pose"]["position"] for each in found["rejected"]])
    assert np.linalg.norm(rejected - grasps.mean(axis=0), axis=1).max() < 0.4
    assert "beyond_max_grasps" not in {each["reason"]["code"] for each in found["rejected"]}


def test_without_grasps_asked_for_nothing_is_rejected(backend: Client) -> None:
    assert "rejected" not in ask(backend, rejected="20", max_grasps="0")


@pytest.mark.parametrize("query", [{"rejected": "201"}, {"rejected": "-1"}, {"rejected": "few"}])
def test_other_numbers_are_refused(backend: Client, query: dict[str, str]) -> None:
    refused(backend, query, "rejected")


def test_other_formats_have_no_place_for_them(backend: Client) -> None:
    refused(backend, {"rejected": "5", "format": "moveit"}, "rejected hand poses")


def refused(backend: Client, query: dict[str, str], named: str) -> None:
    asked = {"task": "hammering", **query}
    response = backend.request("POST", "/grasp", params=asked, content=HAMMER, headers=NPZ)
    assert response.status_code == 422
    assert named in response.json()["error"]["message"]
