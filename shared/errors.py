"""The one error tree: every class carries its code and HTTP status.

A message names the culprit: which field, what was found, what is allowed.
Services raise these; `shared.service` turns them into the envelope of the
public contract, and the typed client turns the envelope back into them.
"""

from __future__ import annotations

from typing import Any, ClassVar

JsonObject = dict[str, Any]


class SpargeError(Exception):
    """Base of all errors that may reach a client.

    Parameters
    ----------
    message : str
        One or two sentences for a person.
    **details
        JSON-compatible facts for a program (field, found, allowed, ...).

    Attributes
    ----------
    request_id : str or None
        Of the request that was answered with it, where a client raises it.
    """

    code: ClassVar[str] = "internal"
    status: ClassVar[int] = 500
    retry_after_s: ClassVar[int | None] = None
    by_code: ClassVar[dict[str, type[SpargeError]]] = {}

    def __init_subclass__(cls) -> None:
        SpargeError.by_code[cls.code] = cls

    def __init__(self, message: str, **details: Any) -> None:
        super().__init__(message)
        self.message = message
        self.details: JsonObject = details
        self.request_id: str | None = None

    def envelope(self, request_id: str) -> JsonObject:
        """Return the contract's JSON body of this error."""
        return {
            "error": {
                "code": self.code,
                "message": self.message,
                "details": self.details,
                "request_id": request_id,
            }
        }


class InternalError(SpargeError):
    """A fault of ours; the details stay in the log."""


class MalformedRequest(SpargeError):
    """The body cannot be parsed at all."""

    code = "malformed"
    status = 400


class Unauthorized(SpargeError):
    """No credentials, or wrong ones."""

    code = "unauthorized"
    status = 401


class Forbidden(SpargeError):
    """Credentials that do not open this, or a place that is not answered from here."""

    code = "forbidden"
    status = 403


class NotFound(SpargeError):
    """No such path or resource."""

    code = "not_found"
    status = 404


class NoSuchPath(NotFound):
    """The service has no such endpoint."""

    code = "no_such_path"


class MethodNotAllowed(SpargeError):
    """The path exists, the method does not."""

    code = "method_not_allowed"
    status = 405


class Conflict(SpargeError):
    """The change contradicts what is already known."""

    code = "conflict"
    status = 409


class PayloadTooLarge(SpargeError):
    """More bytes, or more unpacked bytes, than the service accepts."""

    code = "too_large"
    status = 413


class UnsupportedMediaType(SpargeError):
    """A content type or file format that the service does not read."""

    code = "unsupported_media_type"
    status = 415


class InvalidInput(SpargeError):
    """Parsed, but not valid: says which field, what was found, what is allowed."""

    code = "invalid_input"
    status = 422


class EmptyCloud(InvalidInput):
    """Too few valid points to work with."""

    code = "empty_cloud"


class DegenerateCloud(InvalidInput):
    """The points lie on a plane, a line or a spot: there is no volume to recover."""

    code = "degenerate_cloud"


class NoObject(InvalidInput):
    """A support surface, but nothing on it."""

    code = "no_object"


class WrongUnits(InvalidInput):
    """Coordinates that look like millimetres."""

    code = "wrong_units"


class UnreadableFile(InvalidInput):
    """A file that takes more memory or time to read than allowed, or crashes what reads it."""

    code = "unreadable_file"


class UnknownTask(InvalidInput):
    """The knowledge base has no such task; the details list the known ones."""

    code = "unknown_task"


class UnknownGripper(InvalidInput):
    """No such gripper; the details list the known ones."""

    code = "unknown_gripper"


class BodyTooSlow(SpargeError):
    """The body did not arrive in time."""

    code = "body_too_slow"
    status = 408


class TooBusy(SpargeError):
    """All workers are taken; ask again later. `details.retry_after_s` says when, if known."""

    code = "too_busy"
    status = 429
    retry_after_s = 1


class RateLimited(SpargeError):
    """The client asks more often than it may; `details.retry_after_s` says when to go on."""

    code = "rate_limited"
    status = 429
    retry_after_s = 1


class StageUnavailable(SpargeError):
    """A stage is down, or answers nonsense; the details say which."""

    code = "stage_unavailable"
    status = 503
    retry_after_s = 2


class NotStored(StageUnavailable):
    """A change of the knowledge cannot be written to disk; nothing of it was taken."""

    code = "not_stored"


class DeadlineExceeded(SpargeError):
    """The answer was not ready in time."""

    code = "deadline_exceeded"
    status = 504


def error_from_envelope(status: int, body: object) -> SpargeError | None:
    """Rebuild the error that a service answered with.

    Returns None when `body` is not an envelope, so that the caller can treat
    the answer as nonsense.
    """
    if not isinstance(body, dict) or not isinstance(error := body.get("error"), dict):
        return None
    code, message, details = error.get("code"), error.get("message"), error.get("details")
    if not isinstance(code, str) or not isinstance(message, str):
        return None
    kind = SpargeError.by_code.get(code)
    if kind is None:
        kind = InvalidInput if 400 <= status < 500 else InternalError
    rebuilt = kind(message, **(details if isinstance(details, dict) else {}))
    identifier = error.get("request_id")
    rebuilt.request_id = identifier if isinstance(identifier, str) else None
    return rebuilt
