"""`shared.client`, the clients that people use, against a real backend.

Every test runs with `Sparge` and `AsyncSparge`, in this process and over a socket.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse, Response

from shared.client import AsyncSparge, RankedGrasp, RetryPolicy, Sparge, Transform
from shared.errors import (
    DeadlineExceeded,
    InvalidInput,
    NotFound,
    StageUnavailable,
    Unauthorized,
    UnknownTask,
)
from shared.geometry.points import points_from_depth
from shared.schemas.primitive import PRESETS
from shared.schemas.route import Nothing
from shared.schemas.task import ADD_TASK, DELETE_TASK, LIST_TASKS, TaskDefinition, TaskName
from shared.service.envelope import error_response
from tests.support.both_clients import in_loop, of_kind
from tests.support.relay import relay
from tests.support.samples import sample_path, sample_view
from tests.support.serving import Client, free_ports, serving

TASK = "pouring"


@pytest.fixture(scope="module")
def url(backend: Client) -> Iterator[str]:
    with serving(relay(backend)) as at:
        yield at


@pytest.fixture(params=["sync, in process", "async, in process", "sync, socket", "async, socket"])
def sparge(request: pytest.FixtureRequest, backend: Client) -> Iterator[Any]:
    kind, where = request.param.split(", ")
    if where == "socket":
        with of_kind(kind, request.getfixturevalue("url")) as client:
            yield client
        return
    send = backend.request if kind == "sync" else in_loop(backend.request)
    with of_kind(kind, send) as client:
        yield client


@pytest.fixture
def embedded(backend: Client) -> Sparge:
    return Sparge(backend.request)


def bottle() -> np.ndarray:
    view = sample_view("bottle")
    return points_from_depth(view["depth"], view["intrinsics"], view["depth_scale"])


def test_three_lines_from_an_array_to_a_grasp(url: str) -> None:
    points = bottle()
    lines = """from shared.client import Sparge
sparge = Sparge(url)
grasp = sparge.grasp(points, task="pouring").best"""
    known: dict[str, Any] = {"url": url, "points": points}
    exec(lines, known)
    grasp = known["grasp"]
    assert isinstance(grasp, RankedGrasp)
    assert grasp.pose.name == "camera_from_grasp"
    assert grasp.score > 0.5


def test_arrays_files_and_paths_give_the_same(embedded: Sparge) -> None:
    view, path = sample_view("bottle"), sample_path("bottle")
    by_array = embedded.grasp(view, TASK, max_grasps=3)
    by_file = embedded.grasp_file(path.name, path.read_bytes(), TASK, max_grasps=3)
    by_path = embedded.grasp(path, TASK, max_grasps=3)
    depth = view.pop("depth")
    by_image = embedded.grasp(depth, TASK, max_grasps=3, **view)
    for other in (by_file, by_path, by_image):
        np.testing.assert_array_equal(by_array.grasps, other.grasps)
        np.testing.assert_array_equal(by_array.point_region, other.point_region)
        assert by_array.answer.region == other.answer.region
    assert 1 <= len(by_array.answer.grasps) == len(by_array.grasps) <= 3


def test_poses_are_those_of_the_arrays(embedded: Sparge) -> None:
    result = embedded.grasp(sample_view("bottle"), TASK, frame_id="head", max_grasps=3)
    for row, grasp in zip(result.grasps, result.ranked, strict=True):
        np.testing.assert_allclose(grasp.pose.position, row[:3])
        np.testing.assert_allclose(np.abs(grasp.pose.quaternion @ row[3:7]), 1.0)
        assert (grasp.width, grasp.score) == (row[7], row[8])
        assert grasp.pregrasp.name == "head_from_pregrasp"
        approach = grasp.pose.position - grasp.pregrasp.position
        np.testing.assert_allclose(approach / np.linalg.norm(approach), grasp.pose.rotation[:, 2])
    base_from_head = Transform("base", "head", np.eye(4))
    assert result.best is not None
    assert (base_from_head @ result.best.pose).name == "base_from_grasp"
    assert result.best.rank == 0
    assert "hold part 0" in repr(result)
    assert "wrap_grasp" in result.why


def test_an_empty_answer_says_why(embedded: Sparge) -> None:
    result = embedded.grasp(sample_view("bottle"), "hammering")
    assert not result.found
    assert result.best is None
    assert result.reason is not None
    assert result.reason.code in repr(result)
    with pytest.raises(NotFound, match="no grasp 0"):
        result.execution()


def test_parameters_reach_the_backend(sparge: Any) -> None:
    answer = sparge.grasp(
        sample_view("bottle"),
        "handover",
        reasoning="v1",
        explain=False,
        frame_id="head",
        viewpoint=np.zeros(3),
        target=None,
        seed=4,
        max_grasps=1,
    ).answer
    assert len(answer.grasps) == 1
    assert (answer.reasoning, answer.explanation, answer.frame_id) == ("v1", None, "head")
    assert answer.seed == 4


def test_parameters_of_the_recovery_are_a_message_or_a_mapping(embedded: Sparge) -> None:
    alone = PRESETS["simulation"].model_copy(update={"min_points": 100_000})
    for recovery in (alone, alone.model_dump(), alone.model_dump_json()):
        answer = embedded.grasp(
            sample_view("hammer"), "hammering", recovery=recovery, max_grasps=0
        ).answer
        assert len(answer.primitives) == 1
    more = embedded.grasp(
        sample_view("hammer"), "hammering", recovery=PRESETS["simulation"], max_grasps=0
    ).answer
    assert len(more.primitives) > 1


def test_errors_arrive_as_they_were_raised(sparge: Any) -> None:
    with pytest.raises(UnknownTask) as caught:
        sparge.grasp(sample_view("bottle"), "juggling")
    assert TASK in caught.value.details["known"]
    assert len(caught.value.request_id or "") == 32


def test_what_cannot_be_sent_is_refused_here(sparge: Any) -> None:
    with pytest.raises(InvalidInput, match=r"\(480, 640\)"):
        sparge.grasp(np.ones((480, 640)), TASK)
    with pytest.raises(InvalidInput, match="name"):
        sparge.add_task("Not A Name")
    with pytest.raises(InvalidInput, match="list of affordances"):
        sparge.add_task("watering", requires="contain")


def test_tasks_come_and_go(sparge: Any) -> None:
    added = sparge.add_task("watering", requires=["contain"], grasp=["wrap_grasp"])
    try:
        assert added.reasoning == ("v2",)
        assert "watering" in [task.name for task in sparge.tasks()]
        assert sparge.grasp(sample_view("bottle"), "watering", max_grasps=0).found
    finally:
        assert sparge.remove_task("watering") == added


def test_any_route_can_be_called(embedded: Sparge) -> None:
    added = embedded.call(ADD_TASK, TaskDefinition(name="stirring", grasp=("wrap_grasp",)))
    assert "stirring" in [task.name for task in embedded.call(LIST_TASKS, Nothing()).tasks]
    assert embedded.call(DELETE_TASK, TaskName(name="stirring")) == added


def test_the_lists_and_the_state(sparge: Any) -> None:
    assert "panda" in [gripper.name for gripper in sparge.grippers()]
    assert "wrap_grasp" in [affordance.name for affordance in sparge.affordances()]
    assert sparge.version().service == "gateway"
    assert sparge.health().status == "ready"
    assert sparge.ready()
    sparge.wait_until_ready(5.0)


def test_an_earlier_answer_can_be_explained(sparge: Any) -> None:
    answer = sparge.grasp(sample_view("bottle"), TASK, max_grasps=0).answer
    assert sparge.explanation(answer.request_id).explanation == answer.explanation
    with pytest.raises(NotFound):
        sparge.explanation("never-asked")


def test_a_grasp_is_tried_in_simulation(embedded: Sparge) -> None:
    result = embedded.grasp(sample_view("bottle"), TASK, max_grasps=1)
    tried = embedded.execute(result.execution(motion=True))
    assert (tried.outcome, tried.animation) == ("lifted", None)
    assert tried.motion_hand is not None
    assert tried.motion_joints is not None
    assert tried.motion_hand.shape == tried.motion_joints.shape == (len(tried.motion_phases), 7)
    heights = tried.motion_hand[:, :3] @ result.answer.scene.up
    lifting = heights[[name == "lift" for name in tried.motion_phases]]
    assert np.ptp(lifting) == pytest.approx(0.3, abs=0.02)


@pytest.mark.parametrize("kind", ["sync", "async"])
def test_the_deadline_holds_over_a_socket(kind: str, url: str) -> None:
    with (
        of_kind(kind, url, timeout_s=0.05) as sparge,
        pytest.raises(DeadlineExceeded) as caught,
    ):
        sparge.grasp(sample_view("bottle"), TASK)
    assert caught.value.request_id


def test_questions_are_asked_at_once(url: str) -> None:
    async def ask() -> list[str]:
        async with AsyncSparge(url) as sparge:
            view = sample_view("bottle")
            results = await asyncio.gather(
                *(sparge.grasp(view, task, max_grasps=0) for task in (TASK, "handover"))
            )
        return [result.answer.task for result in results]

    assert asyncio.run(ask()) == [TASK, "handover"]


@pytest.mark.parametrize("kind", ["sync", "async"])
def test_nobody_there(kind: str) -> None:
    (port,) = free_ports(1)
    quick = RetryPolicy(attempts=2, backoff_s=0.01)
    with (
        of_kind(kind, f"http://127.0.0.1:{port}", retries=quick) as sparge,
        pytest.raises(StageUnavailable, match=r"backend cannot be reached: .*asked 2 times"),
    ):
        sparge.tasks()


@pytest.mark.parametrize("kind", ["sync", "async"])
def test_who_never_becomes_ready(kind: str) -> None:
    (port,) = free_ports(1)
    with (
        of_kind(kind, f"http://127.0.0.1:{port}") as sparge,
        pytest.raises(StageUnavailable, match="cannot be reached"),
    ):
        sparge.wait_until_ready(0.3)


@pytest.mark.parametrize("kind", ["sync", "async"])
def test_the_key_is_shown(kind: str) -> None:
    app = FastAPI()

    @app.get("/version")
    def version(request: Request) -> Response:
        if request.headers.get("authorization") == "Bearer right":
            return JSONResponse({"service": "gateway", "version": "1"})
        return error_response(Unauthorized("another key is wanted"), "abc")

    with serving(app) as url:
        with of_kind(kind, url, api_key="right") as sparge:
            assert sparge.version().version == "1"
        with of_kind(kind, url, api_key="wrong") as sparge, pytest.raises(Unauthorized) as caught:
            sparge.version()
    assert caught.value.request_id == "abc"


@pytest.mark.parametrize("kind", ["sync", "async"])
def test_another_web_server_is_no_backend(kind: str) -> None:
    with serving(FastAPI()) as url, of_kind(kind, url) as sparge:
        for ask in (sparge.tasks, sparge.version, sparge.health):
            with pytest.raises(StageUnavailable, match="is its URL right"):
                ask()
