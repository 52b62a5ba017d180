"""Message <-> bytes, in JSON or npz.

JSON carries arrays as nested lists. npz carries every array field under its
own name and the rest of the message as UTF-8 JSON in the array `message`.
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
import orjson
from pydantic import ValidationError

from shared.errors import InvalidInput, MalformedRequest, UnsupportedMediaType
from shared.wire.message import Message
from shared.wire.npz import read_npz, write_npz

JSON = "application/json"
NPZ = "application/x-npz"
ENVELOPE = "message"

M = TypeVar("M", bound=Message)


def encode(message: Message, media_type: str = JSON) -> bytes:
    """Return `message` as bytes of `media_type` (`JSON` or `NPZ`)."""
    if media_type == JSON:
        return message.model_dump_json().encode()
    arrays = {
        name: value
        for name in type(message).array_fields()
        if (value := getattr(message, name)) is not None
    }
    rest = message.model_dump_json(exclude=set(type(message).array_fields())).encode()
    return write_npz({**arrays, ENVELOPE: np.frombuffer(rest, dtype=np.uint8)})


def decode(kind: type[M], data: bytes, media_type: str, max_unpacked_bytes: int) -> M:
    """Return the message of type `kind` that `data` holds.

    Raises
    ------
    MalformedRequest
        The bytes are not JSON, or not a sound npz archive.
    InvalidInput
        They are, but the content does not validate; the details name each field.
    PayloadTooLarge
        The archive unpacks to more than `max_unpacked_bytes`.
    UnsupportedMediaType
        `media_type` is neither JSON nor npz.
    """
    base = media_type.split(";", 1)[0].strip().lower()
    if base == JSON:
        fields = read_json_object(data)
    elif base == NPZ:
        fields = dict(read_npz(data, max_unpacked_bytes))
        if ENVELOPE in fields:
            fields |= read_json_object(fields.pop(ENVELOPE).tobytes())
    else:
        raise UnsupportedMediaType(
            f"content type {base or 'none'!r} is not read here; send {JSON} or {NPZ}",
            found=base,
            allowed=[JSON, NPZ],
        )
    return validate(kind, fields)


def read_json_object(data: bytes) -> dict[str, Any]:
    """Parse a JSON object; `NaN` and `Infinity` are not JSON.

    Raises
    ------
    MalformedRequest
        Not JSON, or not an object.
    """
    try:
        parsed = orjson.loads(data)
    except orjson.JSONDecodeError as error:
        raise MalformedRequest(f"the body is not JSON: {error}") from None
    if not isinstance(parsed, dict):
        raise MalformedRequest(f"the body is a JSON {type(parsed).__name__}, expected an object")
    return parsed


def validate(kind: type[M], fields: dict[str, Any]) -> M:
    """Return `kind` built from `fields`, or raise `InvalidInput` naming each bad field."""
    try:
        return kind.model_validate(fields)
    except ValidationError as error:
        raise invalid(error) from None


def invalid(error: ValidationError) -> InvalidInput:
    """Return the contract's error for a pydantic one, without echoing bulk input."""
    problems = [
        {"field": ".".join(map(str, each["loc"])) or "body", "problem": each["msg"]}
        for each in error.errors(include_url=False, include_context=False, include_input=False)
    ]
    shown = "; ".join(f"{each['field']}: {each['problem']}" for each in problems[:5])
    return InvalidInput(f"the request is not valid: {shown}", fields=problems[:20])
