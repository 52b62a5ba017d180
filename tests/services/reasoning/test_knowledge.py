"""Tasks that are added: known at once, kept over a restart, and nothing half done."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
from shared.errors import (
    Conflict,
    InvalidInput,
    NotFound,
    StageUnavailable,
    UnknownTask,
)
from shared.schemas.route import Nothing
from shared.schemas.task import DecideRequest, Task, TaskDefinition, TaskName
from tests.services.reasoning.objects import BOTTLE, PAN

STIRRING = TaskDefinition(
    name="stirring", description="Move round and round.", requires=("grasp",), grasp=("grasp",)
)


def tasks(reasoner: Reasoner) -> dict[str, Task]:
    return {task.name: task for task in reasoner.list_tasks(Nothing()).tasks}


def request(task: str, **fields: object) -> DecideRequest:
    return DecideRequest.model_validate({"task": task, "primitives": PAN, **fields})


def test_shipped_tasks(reasoner: Reasoner) -> None:
    listed = tasks(reasoner)
    assert list(listed) == sorted(listed)
    assert len(listed) == 7
    for task in listed.values():
        assert task.builtin
        assert task.reasoning == ("v1", "v2")
        assert task.description
    assert listed["pouring"].requires == ("contain",)
    assert listed["pouring"].grasp == ("grasp", "wrap_grasp")
    assert listed["handover"].avoids == ("wrap_grasp",)


def test_affordances(reasoner: Reasoner) -> None:
    listed = reasoner.list_affordances(Nothing()).affordances
    names = ["contain", "cut", "grasp", "pound", "scoop", "support", "wrap_grasp"]
    assert [each.name for each in listed] == names
    assert all(each.description for each in listed)


def test_an_added_task_is_known_to_the_next_request(reasoner: Reasoner) -> None:
    added = reasoner.add_task(STIRRING)
    assert added.reasoning == ("v2",)
    assert not added.builtin
    assert tasks(reasoner)["stirring"] == added
    region = reasoner.decide(request("stirring")).region
    assert region is not None
    assert region.primitive_ids == (1,)


def test_an_added_task_survives_a_restart(settings: ReasoningSettings, reasoner: Reasoner) -> None:
    reasoner.add_task(STIRRING)
    reasoner.add_task(TaskDefinition(name="offering", avoids=("grasp", "cut")))
    again = Reasoner(settings)
    try:
        assert tasks(again) == tasks(reasoner)
        for task in ("stirring", "offering"):
            assert again.decide(request(task)) == reasoner.decide(request(task))
    finally:
        again.close()


def test_a_deleted_task_is_gone_for_good(settings: ReasoningSettings, reasoner: Reasoner) -> None:
    added = reasoner.add_task(STIRRING)
    assert reasoner.delete_task(TaskName(name="stirring")) == added
    with pytest.raises(UnknownTask):
        reasoner.decide(request("stirring"))
    with pytest.raises(NotFound):
        reasoner.delete_task(TaskName(name="stirring"))
    again = Reasoner(settings)
    try:
        assert "stirring" not in tasks(again)
    finally:
        again.close()
    reasoner.add_task(STIRRING)


def test_two_reasoners_do_not_share_what_they_learn(tmp_path: Path, reasoner: Reasoner) -> None:
    other = Reasoner(ReasoningSettings(knowledge_dir=tmp_path / "other"))
    try:
        reasoner.add_task(STIRRING)
        with pytest.raises(UnknownTask):
            other.decide(request("stirring"))
    finally:
        other.close()
    assert reasoner.decide(request("stirring")).found


def test_version_1_says_that_it_has_no_rule(reasoner: Reasoner) -> None:
    reasoner.add_task(STIRRING)
    with pytest.raises(UnknownTask, match="v1 has no rule for 'stirring'") as caught:
        reasoner.decide(request("stirring", reasoning="v1"))
    assert caught.value.details["known_to"] == ["v2"]
    assert "stirring" not in caught.value.details["known"]


@pytest.mark.parametrize("field", ["requires", "grasp", "avoids"])
def test_unknown_affordances_are_named(reasoner: Reasoner, field: str) -> None:
    definition = STIRRING.model_copy(update={field: ("grasp", "juggle")})
    with pytest.raises(InvalidInput, match="juggle") as caught:
        reasoner.add_task(definition)
    assert caught.value.details["field"] == field
    assert "wrap_grasp" in caught.value.details["known"]
    assert "stirring" not in tasks(reasoner)


def test_a_task_says_what_to_hold(reasoner: Reasoner) -> None:
    with pytest.raises(InvalidInput, match="grasp or avoids"):
        reasoner.add_task(TaskDefinition(name="looking", requires=("contain",)))


@pytest.mark.parametrize("name", ["cooking", "stirring", "wrap_grasp"])
def test_a_taken_name_is_a_conflict(reasoner: Reasoner, name: str) -> None:
    reasoner.add_task(STIRRING)
    with pytest.raises(Conflict):
        reasoner.add_task(TaskDefinition(name=name, avoids=("grasp",)))


def test_shipped_tasks_stay(reasoner: Reasoner) -> None:
    with pytest.raises(Conflict, match="shipped"):
        reasoner.delete_task(TaskName(name="pouring"))
    assert reasoner.decide(request("pouring", primitives=BOTTLE)).found


def test_of_many_at_once_one_gets_the_name(reasoner: Reasoner) -> None:
    def attempt(number: int) -> bool:
        try:
            reasoner.add_task(STIRRING.model_copy(update={"description": str(number)}))
        except Conflict:
            return False
        return True

    with ThreadPoolExecutor(8) as pool:
        assert sum(pool.map(attempt, range(24))) == 1


def test_a_folder_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    reasoner = Reasoner(ReasoningSettings(knowledge_dir=tmp_path / "file" / "knowledge"))
    try:
        with pytest.raises(StageUnavailable, match="SPARGE_REASONING_KNOWLEDGE_DIR"):
            reasoner.add_task(STIRRING)
        assert "stirring" not in tasks(reasoner)
        assert reasoner.decide(request("cooking")).found
    finally:
        reasoner.close()


@hypothesis_settings(
    max_examples=50,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(description=st.text(max_size=80))
def test_any_description_is_kept(
    settings: ReasoningSettings, reasoner: Reasoner, description: str
) -> None:
    task = STIRRING.model_copy(update={"description": description})
    added = reasoner.add_task(task)
    again = Reasoner(settings)
    try:
        assert tasks(again)["stirring"] == added
        assert added.description == description
    finally:
        again.close()
        reasoner.delete_task(TaskName(name="stirring"))


def test_with_a_thousand_tasks(reasoner: Reasoner, settings: ReasoningSettings) -> None:
    for number in range(1000):
        reasoner.add_task(STIRRING.model_copy(update={"name": f"stirring_{number}"}))
    again = Reasoner(settings)
    try:
        assert len(tasks(again)) == 1007
        assert again.decide(request("stirring_999")).found
        assert again.decide(request("cooking")) == reasoner.decide(request("cooking"))
    finally:
        again.close()
