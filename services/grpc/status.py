"""Errors of the HTTP interface -> gRPC status codes and trailing metadata."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import grpc
from google.protobuf import struct_pb2
from google.protobuf.json_format import ParseDict, ParseError

from services.grpc.generated import sparge_pb2 as pb
from shared.errors import NoSuchPath, SpargeError

ERROR_TRAILER = "sparge-error-bin"
REQUEST_ID_TRAILER = "x-request-id"
RETRY_AFTER_TRAILER = "retry-after"
PUSHBACK_TRAILER = "grpc-retry-pushback-ms"
"""How long clients with a retry policy wait (gRPC proposal A6)."""
_MAX_ERROR_BYTES = 4096
"""gRPC allows 8 KiB of metadata unless told otherwise, and the message travels as well."""
_MAX_TEXT = 1024

STATUS_CODES = {
    400: grpc.StatusCode.INVALID_ARGUMENT,
    401: grpc.StatusCode.UNAUTHENTICATED,
    403: grpc.StatusCode.PERMISSION_DENIED,
    404: grpc.StatusCode.NOT_FOUND,
    405: grpc.StatusCode.UNIMPLEMENTED,
    408: grpc.StatusCode.DEADLINE_EXCEEDED,
    409: grpc.StatusCode.FAILED_PRECONDITION,
    413: grpc.StatusCode.RESOURCE_EXHAUSTED,
    415: grpc.StatusCode.INVALID_ARGUMENT,
    422: grpc.StatusCode.INVALID_ARGUMENT,
    429: grpc.StatusCode.RESOURCE_EXHAUSTED,
    503: grpc.StatusCode.UNAVAILABLE,
    504: grpc.StatusCode.DEADLINE_EXCEEDED,
}
"""By HTTP status; what is not listed is INTERNAL."""


@dataclass(eq=False)
class Failure(Exception):
    """The error that a call is answered with.

    Attributes
    ----------
    http_status : int
        What the HTTP interface answers.
    code, message, details, request_id
        Of its envelope.
    retry_after_s : int or None
        When to ask again.
    """

    http_status: int
    code: str
    message: str
    details: dict[str, Any]
    request_id: str
    retry_after_s: int | None = None

    @classmethod
    def of(cls, error: SpargeError, request_id: str) -> Failure:
        """Return the failure for an error of ours."""
        retry_after_s = error.details.get("retry_after_s", error.retry_after_s)
        return cls(
            error.status, error.code, error.message, error.details, request_id, retry_after_s
        )

    @property
    def status_code(self) -> grpc.StatusCode:
        if self.code == NoSuchPath.code:  # a gateway without this endpoint
            return grpc.StatusCode.UNIMPLEMENTED
        return STATUS_CODES.get(self.http_status, grpc.StatusCode.INTERNAL)

    def trailers(self) -> tuple[tuple[str, str | bytes], ...]:
        """Return the trailing metadata: the envelope, the request's id, when to ask again."""
        given: list[tuple[str, str | bytes]] = [
            (ERROR_TRAILER, self._envelope()),
            (REQUEST_ID_TRAILER, self.request_id),
        ]
        if self.retry_after_s is not None:
            given.append((RETRY_AFTER_TRAILER, str(self.retry_after_s)))
            given.append((PUSHBACK_TRAILER, str(1000 * self.retry_after_s)))
        return tuple(given)

    def shortened(self) -> str:
        """Return the message, bounded: it travels as metadata."""
        return self.message if len(self.message) <= _MAX_TEXT else f"{self.message[:_MAX_TEXT]}..."

    def _envelope(self) -> bytes:
        plain = pb.Error(code=self.code, message=self.shortened(), request_id=self.request_id)
        try:
            whole = pb.Error(details=ParseDict(self.details, struct_pb2.Struct()))
        except ParseError:
            return plain.SerializeToString()
        whole.MergeFrom(plain)
        packed = whole.SerializeToString()
        return packed if len(packed) <= _MAX_ERROR_BYTES else plain.SerializeToString()
