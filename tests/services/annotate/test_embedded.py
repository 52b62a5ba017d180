"""The true backend behind the workers' pipeline."""

from __future__ import annotations

import json
from collections.abc import Iterator
from hashlib import sha256

import pytest

pytest.importorskip("pyarrow")

from services.annotate.label import label
from services.annotate.pipeline import EmbeddedPipeline
from services.annotate.question import Job, Question, Refusal, Terms
from shared.client import Sparge
from shared.errors import InvalidInput, UnknownGripper, UnknownTask
from shared.schemas.task import ADD_TASK, DELETE_TASK, TaskDefinition, TaskName
from tests.support.samples import sample_path
from tests.support.serving import Client

PARAMETERS = {"reasoning": "v2", "input": "scene", "viewpoint": [0, 0, 0], "intrinsics": None}
TASK = TaskDefinition(name="annotate_watering", requires=("contain",), grasp=("wrap_grasp",))


@pytest.fixture(scope="module")
def pipeline(backend: Client) -> EmbeddedPipeline:
    return EmbeddedPipeline(Sparge(backend.request))


@pytest.fixture
def taught(pipeline: EmbeddedPipeline) -> Iterator[EmbeddedPipeline]:
    pipeline.sparge.call(ADD_TASK, TASK)
    yield pipeline
    pipeline.sparge.call(DELETE_TASK, TaskName(name=TASK.name))


def test_a_view_is_labelled_as_grasp_answers(pipeline: EmbeddedPipeline) -> None:
    data = sample_path("bottle").read_bytes()
    job = Job("deep/bottle.npz", "pouring", sha256(data).hexdigest(), data)
    terms = Terms("{}", "digest")
    one, again = (label(pipeline, job, PARAMETERS, terms) for _ in range(2))
    assert one.equals(again)
    (row,) = one.to_pylist()
    result = pipeline.sparge.grasp_file("x.npz", data, "pouring")
    assert row["grasps"] == result.grasps.tolist()
    assert len(row["grasps"]) > 0
    assert row["points"] == 640 * 480
    assert set(row["region_index"]) == set(result.point_region.nonzero()[0])
    assert json.loads(row["report"])["explanation"]["rules"]


def test_what_is_no_cloud_is_refused(pipeline: EmbeddedPipeline) -> None:
    job = Job("broken.npz", "pouring", "", b"no archive")
    outcome = label(pipeline, job, PARAMETERS, Terms("{}", "digest"))
    assert isinstance(outcome, Refusal)
    assert (outcome.code, outcome.passing) == ("malformed", False)


@pytest.mark.parametrize(
    ("task", "change", "error"),
    [
        ("juggling", {}, UnknownTask),
        ("pouring", {"gripper": "hook"}, UnknownGripper),
        ("pouring", {"viewpoint": [0, 0]}, InvalidInput),
    ],
)
def test_a_question_that_cannot_be_asked(
    pipeline: EmbeddedPipeline, task: str, change: dict[str, object], error: type[Exception]
) -> None:
    with pytest.raises(error):
        pipeline.check(Question((task,), {**PARAMETERS, **change}))


def test_the_digest_is_that_of_what_the_backend_knows(
    pipeline: EmbeddedPipeline, monkeypatch: pytest.MonkeyPatch
) -> None:
    question = Question(("pouring",), PARAMETERS)
    before = pipeline.check(question)
    assert pipeline.check(question) == before
    monkeypatch.setenv("SPARGE_GATEWAY_SAMPLES", "100")
    assert pipeline.check(question) != before


def test_the_digest_changes_with_a_lesson(taught: EmbeddedPipeline) -> None:
    question = Question((TASK.name,), PARAMETERS)
    before = taught.check(question)
    taught.sparge.call(DELETE_TASK, TaskName(name=TASK.name))
    try:
        assert taught.check(Question(("pouring",), PARAMETERS)) != before
    finally:
        taught.sparge.call(ADD_TASK, TASK)
