"""Optional fields: not set in protobuf where JSON has null."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

In = TypeVar("In")
Out = TypeVar("Out")


def maybe(convert: Callable[[In], Out], value: In | None) -> Out | None:
    """Return a value converted, or None where there is none: the message's field is not set."""
    return None if value is None else convert(value)
