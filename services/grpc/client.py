"""Calling the service from Python: one callable per method, and errors as exceptions of ours."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

import grpc
from google.protobuf.json_format import MessageToDict
from google.protobuf.message_factory import GetMessageClass

from services.grpc.generated import sparge_pb2 as pb
from services.grpc.status import ERROR_TRAILER
from shared.errors import InternalError, SpargeError

_DESCRIPTOR = pb.DESCRIPTOR.services_by_name["Sparge"]


class SpargeStub:
    """The calls of proto/sparge.proto on a channel; each takes a message, `timeout`, `metadata`.

    Parameters
    ----------
    channel : grpc.Channel
        Closed by whoever made it.
    """

    Grasp: grpc.UnaryUnaryMultiCallable[pb.GraspRequest, pb.GraspAnswer]
    Explain: grpc.UnaryUnaryMultiCallable[pb.RequestName, pb.KeptExplanation]
    ListTasks: grpc.UnaryUnaryMultiCallable[pb.Nothing, pb.TaskList]
    AddTask: grpc.UnaryUnaryMultiCallable[pb.TaskDefinition, pb.Task]
    DeleteTask: grpc.UnaryUnaryMultiCallable[pb.TaskName, pb.Task]
    ListAffordances: grpc.UnaryUnaryMultiCallable[pb.Nothing, pb.AffordanceList]
    ListGrippers: grpc.UnaryUnaryMultiCallable[pb.Nothing, pb.GripperList]
    Execute: grpc.UnaryUnaryMultiCallable[pb.ExecuteRequest, pb.ExecuteResponse]

    def __init__(self, channel: grpc.Channel) -> None:
        for method in _DESCRIPTOR.methods:
            call = channel.unary_unary(
                f"/{_DESCRIPTOR.full_name}/{method.name}",
                request_serializer=GetMessageClass(method.input_type).SerializeToString,
                response_deserializer=GetMessageClass(method.output_type).FromString,
            )
            setattr(self, method.name, call)


@contextlib.contextmanager
def connect(address: str) -> Iterator[SpargeStub]:
    """Speak to the server at `address` (host:port), in the clear; answers may have any size."""
    options = (("grpc.max_receive_message_length", -1), ("grpc.max_send_message_length", -1))
    with grpc.insecure_channel(address, options) as channel:
        yield SpargeStub(channel)


def error_of(failed: grpc.RpcError) -> SpargeError | None:
    """Return the error that a call was answered with; None: it is gRPC's own."""
    call: Any = failed  # a `grpc.Call` as well, where it ended one
    trailers = call.trailing_metadata() if hasattr(failed, "trailing_metadata") else None
    packed = dict(trailers or ()).get(ERROR_TRAILER)
    if not isinstance(packed, bytes):
        return None
    said = pb.Error.FromString(packed)
    kind = SpargeError.by_code.get(said.code, InternalError)
    return kind(said.message, **MessageToDict(said.details))
