"""NumPy arrays as fields of pydantic models: kind, dtype and shape are checked once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

_ACCEPTED_KINDS = {"f": "fiu", "i": "iu", "u": "iu", "b": "b"}
_JSON_TYPES = {"f": "number", "i": "integer", "u": "integer", "b": "boolean"}


@dataclass(frozen=True)
class ArrayField:
    """Annotation: `Annotated[NDArray[np.float64], ArrayField("float64", ("N", 3))]`.

    Parameters
    ----------
    dtype : str
        The dtype that the field has after validation. Floats accept integers,
        integers accept integers that fit; booleans accept only booleans.
        An empty string keeps the incoming dtype, if it is a real number.
    shape : tuple of int or str
        An int is an exact length, a name any length.
    """

    dtype: str
    shape: tuple[int | str, ...]

    def validate(self, value: object) -> NDArray[Any]:
        """Return `value` as a read-only, C-contiguous array of this dtype and shape.

        Raises
        ------
        PydanticCustomError
            Says what was found and what is allowed.
        """
        try:
            array = np.asarray(value)
        except (ValueError, TypeError):
            raise PydanticCustomError("array", "is not a regular array of numbers") from None
        wanted = np.dtype(self.dtype) if self.dtype else None
        if array.shape == (0,) and array.dtype.kind == "f":
            array = self._empty()  # an empty JSON list carries neither type nor shape
        kinds = _ACCEPTED_KINDS[wanted.kind] if wanted is not None else "fiu"
        if array.dtype.kind not in kinds:
            raise PydanticCustomError(
                "array_dtype",
                "has dtype {found}, allowed is {allowed}",
                {"found": str(array.dtype), "allowed": self.dtype or "any real number"},
            )
        self._check_shape(array)
        if wanted is not None and array.dtype != wanted:
            array = self._cast(array, wanted)
        array = np.ascontiguousarray(array)
        if array.flags.writeable:
            array = array.view()
            array.flags.writeable = False
        return array

    def _empty(self) -> NDArray[Any]:
        lengths = [0 if isinstance(length, str) else length for length in self.shape]
        return np.empty(lengths, self.dtype or "float64")

    def _check_shape(self, array: NDArray[Any]) -> None:
        fits = len(array.shape) == len(self.shape) and all(
            isinstance(want, str) or want == have
            for want, have in zip(self.shape, array.shape, strict=True)
        )
        if not fits:
            raise PydanticCustomError(
                "array_shape",
                "has shape {found}, allowed is {allowed}",
                {"found": str(array.shape), "allowed": self.describe()},
            )

    @staticmethod
    def _cast(array: NDArray[Any], wanted: np.dtype[Any]) -> NDArray[Any]:
        if wanted.kind in "iu" and array.size:
            limits = np.iinfo(wanted)
            if array.min() < limits.min or array.max() > limits.max:
                raise PydanticCustomError(
                    "array_range",
                    "holds values outside {low}..{high}",
                    {"low": int(limits.min), "high": int(limits.max)},
                )
        return array.astype(wanted)

    def describe(self) -> str:
        """Return the shape as people write it: `(N, 3)`."""
        inner = ", ".join(str(length) for length in self.shape)
        return f"({inner},)" if len(self.shape) == 1 else f"({inner})"

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(
            self.validate,
            serialization=core_schema.plain_serializer_function_ser_schema(
                lambda array: array.tolist(), when_used="json"
            ),
        )

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        kind = np.dtype(self.dtype).kind if self.dtype else "f"
        items: JsonSchemaValue = {"type": _JSON_TYPES[kind]}
        for length in reversed(self.shape):
            bounds = {} if isinstance(length, str) else {"minItems": length, "maxItems": length}
            items = {"type": "array", "items": items, **bounds}
        dtype = self.dtype or "number"
        return {**items, "description": f"array of {dtype}, shape {self.describe()}"}
