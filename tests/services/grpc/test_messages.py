"""proto/sparge.proto has every field of the HTTP interface, and none is lost on the way."""

from __future__ import annotations

import itertools
import subprocess
import sys
import types
import typing
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from annotated_types import Len

from services.gateway.request import GraspParameters
from services.grpc import answer, execution, known
from services.grpc.generated import sparge_pb2 as pb
from shared.schemas.answer import GraspAnswer, KeptExplanation, RequestName
from shared.schemas.execution import ExecuteRequest, ExecuteResponse
from shared.schemas.gripper import GripperList, ParallelGripper, SuctionGripper
from shared.schemas.task import AffordanceList, Task, TaskDefinition, TaskList, TaskName
from shared.wire import Message
from shared.wire.arrays import ArrayField
from tests.support.grpc_as_http import plain

ROOT = Path(__file__).parents[3]

VIEW = {"points", "depth", "file", "per_point"}
OF_HTTP = {"format", "pose_of", "stamp"}
"""Formats of other tools are JSON."""

PAIRS: list[tuple[type[Message], Any, set[str]]] = [
    (GraspParameters, pb.GraspRequest.DESCRIPTOR, VIEW | OF_HTTP),
    (GraspAnswer, pb.GraspAnswer.DESCRIPTOR, {"points"}),
    (KeptExplanation, pb.KeptExplanation.DESCRIPTOR, set()),
    (RequestName, pb.RequestName.DESCRIPTOR, set()),
    (TaskDefinition, pb.TaskDefinition.DESCRIPTOR, set()),
    (TaskName, pb.TaskName.DESCRIPTOR, set()),
    (TaskList, pb.TaskList.DESCRIPTOR, set()),
    (AffordanceList, pb.AffordanceList.DESCRIPTOR, set()),
    (ParallelGripper, pb.ParallelGripper.DESCRIPTOR, set()),
    (SuctionGripper, pb.SuctionGripper.DESCRIPTOR, set()),
    (ExecuteRequest, pb.ExecuteRequest.DESCRIPTOR, set()),
    (ExecuteResponse, pb.ExecuteResponse.DESCRIPTOR, set()),
]
"""Message of the HTTP interface, of gRPC, and the fields that only one of them has."""


@pytest.mark.parametrize(
    ("model", "descriptor", "more"), PAIRS, ids=[model.__name__ for model, _, _ in PAIRS]
)
def test_the_messages_have_the_same_fields(
    model: type[Message], descriptor: Any, more: set[str]
) -> None:
    assert differences(model, descriptor, more) == []


def test_a_field_that_is_missing_is_found() -> None:
    class More(GraspAnswer):
        mood: str

    class Regions(Message):
        region: TaskDefinition

    assert differences(More, pb.GraspAnswer.DESCRIPTOR, {"points"}) == ["GraspAnswer: mood"]
    found = differences(Regions, pb.KeptExplanation.DESCRIPTOR, set())
    assert "Region: name" in found
    assert "KeptExplanation: request_id" in found


def test_a_value_that_is_missing_is_found() -> None:
    class Named(Message):
        outcome: Literal["lifted", "held", "dropped"]

    assert "Outcome: dropped" in differences(Named, pb.ExecuteResponse.DESCRIPTOR, set())


def differences(model: type[Message], descriptor: Any, more: set[str]) -> list[str]:
    """Return what only one of two messages has, as `Message: field`, those inside included."""
    fields = {each.name: each for each in descriptor.fields}
    wanted = {name: field.annotation for name, field in model.model_fields.items()}
    wanted.pop("kind", None)  # of a gripper: which of the two messages it is
    found = [
        f"{descriptor.name}: {name}" for name in sorted((wanted.keys() ^ fields.keys()) - more)
    ]
    for name in wanted.keys() & fields.keys():
        inside = fields[name].message_type
        models = [each for each in parts(wanted[name]) if is_message(each)]
        if inside is not None and len(models) == 1:
            found += differences(models[0], inside, set())
        if (enum := fields[name].enum_type) is not None:
            found += _differing_values(wanted[name], enum)
    return found


def _differing_values(annotation: Any, enum: Any) -> list[str]:
    prefix = enum.values_by_number[0].name.removesuffix("UNSPECIFIED")
    allowed = {each for each in parts(annotation) if isinstance(each, str)}
    named = {each.name.removeprefix(prefix).lower() for each in enum.values if each.number}
    return [f"{enum.name}: {each}" for each in sorted(allowed ^ named)] if allowed else []


def parts(annotation: Any) -> list[Any]:
    """Return what an annotation is made of, values of a Literal included."""
    inside = typing.get_args(annotation)
    return [annotation, *itertools.chain.from_iterable(map(parts, inside))]


def is_message(each: Any) -> bool:
    return isinstance(each, type) and issubclass(each, Message)


CONVERTED: list[tuple[type[Message], Callable[[Any], Any]]] = [
    (GraspAnswer, answer.grasp_answer),
    (KeptExplanation, answer.kept_explanation),
    (Task, known.task),
    (TaskList, known.task_list),
    (AffordanceList, known.affordance_list),
    (GripperList, known.gripper_list),
    (ExecuteResponse, execution.execute_response),
]


@pytest.mark.parametrize(("model", "convert"), CONVERTED, ids=lambda each: each.__name__)
@pytest.mark.parametrize("sparse", [False, True], ids=["full", "sparse"])
def test_nothing_is_lost_on_the_way(
    model: type[Message], convert: Callable[[Any], Any], sparse: bool, rng: np.random.Generator
) -> None:
    for _ in range(5):
        filled = fill(model, rng, sparse)
        sent = type(message := convert(filled)).FromString(message.SerializeToString())
        read, wanted = plain(sent), filled.model_dump(mode="json")
        if read.get("animation") is not None:
            read["animation"] = list(read["animation"])
        assert read == wanted


def fill(annotation: Any, rng: np.random.Generator, sparse: bool, name: str = "") -> Any:
    """Return a value of a type at random, messages without validation; sparse: what may be
    None or empty is.
    """
    origin, inside = typing.get_origin(annotation), typing.get_args(annotation)
    if is_message(annotation):
        return annotation.model_construct(
            **{
                field: fill(
                    typing.Annotated[info.annotation, "", *info.metadata], rng, sparse, field
                )
                for field, info in annotation.model_fields.items()
            }
        )
    if origin is typing.Annotated:
        marks = annotation.__metadata__
        for mark in marks:
            if isinstance(mark, ArrayField):
                shape = [3 if isinstance(length, str) else length for length in mark.shape]
                return rng.integers(0, 256, size=shape).astype(mark.dtype)
        exact = [mark.min_length for mark in marks if isinstance(mark, Len)]
        if exact:
            return tuple(float(rng.normal()) for _ in range(exact[0]))
        return fill(inside[0], rng, sparse, name)
    if origin in (typing.Union, types.UnionType):
        if type(None) in inside:
            return None if sparse else fill(inside[0], rng, sparse, name)
        return fill(inside[rng.integers(len(inside))], rng, sparse, name)
    if origin is Literal:
        return inside[rng.integers(len(inside))]
    if origin is dict:
        return {} if sparse else {f"key{i}": fill(inside[1], rng, sparse) for i in range(3)}
    if origin is tuple and inside[-1] is Ellipsis:
        return () if sparse else tuple(fill(inside[0], rng, sparse, name) for _ in range(2))
    if origin is tuple:
        return tuple(fill(each, rng, sparse, name) for each in inside)
    return _fill_scalar(annotation, rng, name)


def _fill_scalar(kind: type, rng: np.random.Generator, name: str) -> Any:
    if name == "rule_set":  # a name that is open over HTTP
        return "thesis"
    scalars: dict[type, Callable[[], Any]] = {
        str: lambda: f"{name} {rng.integers(1, 1000)} ü",
        bool: lambda: bool(rng.integers(2)),
        int: lambda: int(rng.integers(1, 2**31)),
        float: lambda: float(rng.normal()),
    }
    return scalars[kind]()


def test_the_generated_code_is_fresh(tmp_path: Path) -> None:
    made = subprocess.run(
        [
            *(sys.executable, "-m", "grpc_tools.protoc", "--proto_path=proto"),
            *(f"--python_out={tmp_path}", f"--pyi_out={tmp_path}", "proto/sparge.proto"),
        ],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert made.returncode == 0, made.stderr
    for path in tmp_path.iterdir():
        kept = ROOT / "services" / "grpc" / "generated" / path.name
        assert kept.read_text() == path.read_text(), "run `make proto`"
