"""The base of everything that services exchange."""

from __future__ import annotations

import functools
from typing import Any, get_args

import numpy as np
from pydantic import BaseModel, ConfigDict

from shared.wire.arrays import ArrayField


class Message(BaseModel):
    """A frozen value object with optional array fields.

    Bulk arrays are fields of the outermost message, annotated with
    `ArrayField`, so that npz can carry them beside the rest.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", arbitrary_types_allowed=True)

    @classmethod
    def array_fields(cls) -> tuple[str, ...]:
        """Return the names of the fields that hold arrays."""
        return _array_fields(cls)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(
            _same(getattr(self, name), getattr(other, name)) for name in type(self).model_fields
        )

    __hash__ = None  # type: ignore[assignment]


@functools.cache
def _array_fields(kind: type[Message]) -> tuple[str, ...]:
    return tuple(
        name
        for name, field in kind.model_fields.items()
        if any(isinstance(mark, ArrayField) for mark in field.metadata)
        or _mentions_array(field.annotation)
    )


def _mentions_array(annotation: Any) -> bool:
    return isinstance(annotation, ArrayField) or any(map(_mentions_array, get_args(annotation)))


def _same(a: object, b: object) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    return bool(a == b)
