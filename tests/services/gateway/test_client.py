"""`shared.client`, the client that people use, against a real backend."""

from __future__ import annotations

import numpy as np
import pytest

from shared.client import Sparge, connect
from shared.errors import StageUnavailable, UnknownTask
from shared.schemas.primitive import PRESETS
from shared.schemas.route import Nothing
from shared.schemas.task import ADD_TASK, DELETE_TASK, LIST_TASKS, TaskDefinition, TaskName
from tests.support.samples import sample_path, sample_view
from tests.support.serving import Client, free_ports


@pytest.fixture
def sparge(backend: Client) -> Sparge:
    return Sparge(backend.request)


def test_arrays_and_files_give_the_same(sparge: Sparge) -> None:
    by_array = sparge.grasp(sample_view("bottle"), "pouring", max_grasps=3)
    by_file = sparge.grasp_file(
        "bottle.npz", sample_path("bottle").read_bytes(), "pouring", max_grasps=3
    )
    np.testing.assert_array_equal(by_array.grasps, by_file.grasps)
    np.testing.assert_array_equal(by_array.point_region, by_file.point_region)
    assert by_array.answer.region == by_file.answer.region
    assert len(by_array.answer.grasps) == len(by_array.grasps) <= 3


def test_parameters_reach_the_backend(sparge: Sparge) -> None:
    answer = sparge.grasp(
        sample_view("bottle"),
        "handover",
        reasoning="v1",
        explain=False,
        frame_id="head",
        viewpoint=np.zeros(3),
        target=None,
        seed=4,
    ).answer
    assert (answer.reasoning, answer.explanation, answer.frame_id) == ("v1", None, "head")
    assert answer.seed == 4


def test_parameters_of_the_recovery_are_a_message_or_a_mapping(sparge: Sparge) -> None:
    alone = PRESETS["simulation"].model_copy(update={"min_points": 100_000})
    for recovery in (alone, alone.model_dump(), alone.model_dump_json()):
        answer = sparge.grasp(
            sample_view("hammer"), "hammering", recovery=recovery, max_grasps=0
        ).answer
        assert len(answer.primitives) == 1
    more = sparge.grasp(
        sample_view("hammer"), "hammering", recovery=PRESETS["simulation"], max_grasps=0
    ).answer
    assert len(more.primitives) > 1


def test_errors_arrive_as_they_were_raised(sparge: Sparge) -> None:
    with pytest.raises(UnknownTask) as caught:
        sparge.grasp(sample_view("bottle"), "juggling")
    assert "pouring" in caught.value.details["known"]


def test_the_other_endpoints(sparge: Sparge) -> None:
    added = sparge.call(ADD_TASK, TaskDefinition(name="watering", grasp=("wrap_grasp",)))
    assert added.reasoning == ("v2",)
    names = [task.name for task in sparge.call(LIST_TASKS, Nothing()).tasks]
    assert "watering" in names
    assert sparge.call(DELETE_TASK, TaskName(name="watering")) == added


def test_nobody_there() -> None:
    (port,) = free_ports(1)
    with (
        connect(f"http://127.0.0.1:{port}") as sparge,
        pytest.raises(StageUnavailable, match="backend cannot be reached"),
    ):
        sparge.call(LIST_TASKS, Nothing())
