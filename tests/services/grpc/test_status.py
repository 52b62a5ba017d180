"""Errors as gRPC tells them."""

from __future__ import annotations

import grpc
from google.protobuf.json_format import MessageToDict

from services.grpc.generated import sparge_pb2 as pb
from services.grpc.status import STATUS_CODES, Failure
from shared.errors import (
    Conflict,
    InternalError,
    NoSuchPath,
    RateLimited,
    SpargeError,
    StageUnavailable,
    UnknownTask,
)


def test_every_error_has_its_status_code() -> None:
    statuses = {kind.status for kind in SpargeError.by_code.values()} - {InternalError.status}
    assert statuses == set(STATUS_CODES)
    assert Failure.of(InternalError("x"), "7").status_code is grpc.StatusCode.INTERNAL
    assert Failure.of(NoSuchPath("x"), "7").status_code is grpc.StatusCode.UNIMPLEMENTED
    assert Failure.of(Conflict("x"), "7").status_code is grpc.StatusCode.FAILED_PRECONDITION


def test_the_envelope_travels_in_the_trailers() -> None:
    error = UnknownTask("no such task", known=["pouring"], found="juggling", depth={"a": 1.5})
    trailers = dict(Failure.of(error, "robot-7").trailers())
    said = pb.Error.FromString(trailers["sparge-error-bin"])  # type: ignore[arg-type]
    assert (said.code, said.message, said.request_id) == ("unknown_task", "no such task", "robot-7")
    details = MessageToDict(said.details)
    assert details == {"known": ["pouring"], "found": "juggling", "depth": {"a": 1.5}}
    assert trailers["x-request-id"] == "robot-7"
    assert "retry-after" not in trailers


def test_when_to_ask_again_travels_too() -> None:
    trailers = dict(Failure.of(RateLimited("slow down", retry_after_s=3), "7").trailers())
    assert trailers["retry-after"] == "3"
    assert trailers["grpc-retry-pushback-ms"] == "3000"
    assert dict(Failure.of(StageUnavailable("down"), "7").trailers())["retry-after"] == "2"


def test_trailers_stay_small() -> None:
    error = UnknownTask("é" * 5000, known=["pouring"] * 5000)
    failure = Failure.of(error, "7")
    said = pb.Error.FromString(dict(failure.trailers())["sparge-error-bin"])  # type: ignore[arg-type]
    assert said.code == "unknown_task"
    assert not said.details.fields
    size = sum(len(key) + len(value) for key, value in failure.trailers())
    assert size + len(failure.shortened().encode()) < 8192


def test_details_that_json_cannot_hold_are_left_out() -> None:
    failure = Failure.of(UnknownTask("x", found=object()), "7")
    said = pb.Error.FromString(dict(failure.trailers())["sparge-error-bin"])  # type: ignore[arg-type]
    assert said.code == "unknown_task"
