"""Grasps tried in physics: which ones, on which objects, and what is written down."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from experiments.catalogue.mass import mass_properties
from experiments.dataset.drop import body_of
from experiments.trials.candidates import spread
from experiments.trials.collecting import Collector, Job, jobs_of, wait_until_ready
from experiments.trials.scenes import (
    MASSES,
    PER_ROUND,
    SAUCE_BOTTLE,
    TRIANGLES,
    draw_mass,
    draw_object,
    draw_scene,
    simplified,
)
from experiments.trials.trials import execution, try_out
from shared.client import GraspResult, Sparge
from shared.errors import DeadlineExceeded, NotFound, StageUnavailable
from shared.geometry.se3 import matrix_from_pose, transform_points
from shared.schemas.execution import BELIEVED, ExecuteRequest, ExecuteResponse

GRASPS = np.column_stack(
    [
        np.random.default_rng(0).normal(size=(40, 3)),
        np.tile([0.0, 0.0, 0.6, 0.8], (40, 1)),
        np.full(40, 0.03),
        np.linspace(1, 0, 40),
    ]
)


def test_the_best_grasp_and_one_of_each_stratum_are_tried() -> None:
    tried = spread(GRASPS, 6, np.random.default_rng(1))
    assert tried.rank[0] == 0
    assert not tried.moved[0]
    assert (np.diff(tried.rank) > 0).all()
    np.testing.assert_array_equal(tried.grasps[~tried.moved], GRASPS[tried.rank[~tried.moved]])


def test_moved_grasps_are_near_where_they_were() -> None:
    shifts = []
    for seed in range(30):
        tried = spread(GRASPS, 8, np.random.default_rng(seed))
        assert np.linalg.norm(tried.grasps[:, 3:7], axis=1) == pytest.approx(1.0)
        shifts.append((tried.grasps[:, :3] - GRASPS[tried.rank, :3])[tried.moved])
    moved = np.concatenate(shifts)
    assert 0.2 < len(moved) / (30 * 7) < 0.4
    assert moved.std() == pytest.approx(0.003, rel=0.2)


def test_few_grasps_are_all_tried() -> None:
    assert spread(GRASPS[:3], 6, np.random.default_rng(0)).rank.tolist() == [0, 1, 2]


def test_objects_depend_on_seed_class_and_number_alone() -> None:
    one, same = draw_object("mug", 3, 7), draw_object("mug", 3, 7)
    np.testing.assert_array_equal(one.vertices, same.vertices)
    assert one.vertices.shape != (other := draw_object("mug", 4, 7).vertices).shape or (
        np.abs(one.vertices - other).max() > 1e-4
    )


def test_a_round_has_so_many_of_each_kind_and_none_comes_twice() -> None:
    jobs = jobs_of(range(3, 5))
    assert len(set(jobs)) == len(jobs) == 2 * sum(PER_ROUND.values())
    assert {kind: sum(job.kind == kind for job in jobs) for kind in PER_ROUND} == {
        kind: 2 * count for kind, count in PER_ROUND.items()
    }
    assert not set(jobs) & set(jobs_of(range(5, 7)))
    assert jobs_of(range(3, 4)) == jobs[: len(jobs) // 2], "a longer run goes on with a shorter one"


def test_of_a_sauce_bottle_the_cap_alone_is_wanted() -> None:
    thing = draw_object(SAUCE_BOTTLE, 4, 0)
    assert thing.tasks == ("handover",)
    assert thing.regions["handover"] == ("cap",)
    assert thing.class_name == SAUCE_BOTTLE
    assert thing.name == "sauce_bottle-4"


def test_the_executed_mesh_is_the_object_with_fewer_triangles() -> None:
    pan = draw_object("pan", 0, 0)
    vertices, faces = simplified(pan)
    assert len(faces) <= 1.1 * TRIANGLES < len(pan.surface.faces)
    assert np.ptp(vertices, axis=0) == pytest.approx(np.ptp(pan.vertices, axis=0), abs=0.003)


def test_masses_are_between_a_light_guess_and_the_truth() -> None:
    pan, spoon = draw_object("pan", 1, 0), draw_object("spoon", 0, 0)
    drawn = [draw_mass(pan, np.random.default_rng(seed)) for seed in range(8)]
    truth = min(mass_properties(pan).mass, MASSES[1])
    assert 0.05 < min(drawn) < 0.7 * truth
    assert min(drawn) < max(drawn) < truth + 1e-9
    assert draw_mass(spoon, np.random.default_rng(0)) == pytest.approx(MASSES[0])


def test_a_grasp_is_executed_on_the_object_where_it_lies() -> None:
    scene = draw_scene(body_of(draw_object("hammer", 0, 0)), 0, 0)
    row = np.array([*scene.shown.object_points.mean(axis=0), 0, 0, 0, 1, 0.03, 0.5])
    request = execution(scene, row, "panda")
    assert request.vertices is not None
    assert request.object_pose is not None
    camera_from_object = matrix_from_pose(
        request.object_pose.position, request.object_pose.quaternion
    )
    lies = transform_points(camera_from_object, request.vertices)
    seen = scene.shown.object_points
    assert (seen.min(axis=0) > lies.min(axis=0) - 0.02).all()
    assert (seen.max(axis=0) < lies.max(axis=0) + 0.02).all()
    assert request.strict
    assert request.actor == "hand"
    assert request.mass == scene.mass


def test_views_that_cannot_be_answered_are_left_out_and_not_asked_again(tmp_path: Path) -> None:
    scene = draw_scene(body_of(draw_object("hammer", 0, 0)), 0, 0)

    class Refusing(Sparge):
        def grasp(self, view: object, task: str, **parameters: object) -> GraspResult:
            raise NotFound("no such task")

    def judge(request: ExecuteRequest) -> ExecuteResponse:
        raise DeadlineExceeded("the simulation took too long")

    nothing = try_out(
        Refusing(lambda *_, **__: pytest.fail("asked")),
        judge,
        scene,
        blind=("any",),
        grippers=("panda",),
        each=4,
        seed=0,
    )
    assert nothing is None
    work = Collector(tmp_path, "http://x", 0, 4, 2, ("panda",), ("any",), lambda _: judge)
    job = Job("hammer", 0)
    work.path(job, 0).with_suffix(".none").touch()
    assert not work.is_done(job)
    work.path(job, 1).touch()
    assert work.is_done(job)


def test_a_backend_that_never_gets_ready_is_an_error() -> None:
    with pytest.raises(StageUnavailable, match="not ready after 0 s"):
        wait_until_ready("http://127.0.0.1:9", 0.0)


@pytest.mark.parametrize(
    ("rehearse", "comes_to_an_end"), [(True, True), (True, False), (False, True)]
)
def test_each_grasp_is_rehearsed_on_what_was_recovered_where_that_is_wanted(
    sparge: Sparge, rehearse: bool, comes_to_an_end: bool
) -> None:
    scene = draw_scene(body_of(draw_object("hammer", 0, 0)), 0, 0)
    rehearsals: list[ExecuteRequest] = []

    def judge(request: ExecuteRequest) -> ExecuteResponse:
        on_mesh = request.vertices is not None
        if not on_mesh:
            rehearsals.append(request)
            if not comes_to_an_end:
                raise DeadlineExceeded("the simulation took too long")
        return ExecuteResponse(
            success=not on_mesh,
            lifted=not on_mesh,
            outcome="slipped_in_lift" if on_mesh else "held",
            message="",
            lift_height=0.0,
            phases=(),
        )

    arrays = try_out(
        sparge,
        judge,
        scene,
        blind=("handover",),
        grippers=("panda",),
        each=2,
        seed=0,
        rehearse=rehearse,
    )
    assert arrays is not None
    shapes = len(BELIEVED)
    assert len(rehearsals) == (shapes if rehearse else 0) * len(arrays["grasps"])
    assert arrays["rehearsed"].shape == (len(arrays["grasps"]), shapes)
    assert set(arrays["outcome"]) == {"slipped_in_lift"}
    assert set(arrays["rehearsed"].ravel()) == {"held" if rehearse and comes_to_an_end else ""}
    rows = np.repeat(arrays["grasps"], shapes, axis=0)[: len(rehearsals)]
    for request, row in zip(rehearsals, rows, strict=True):
        assert request.pose.position == pytest.approx(row[:3])
        assert len(request.primitives) == len(arrays["superquadrics"])
        assert request.mass is None, "what it weighs is not known yet"
