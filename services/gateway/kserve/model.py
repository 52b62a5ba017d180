"""What the model `sparge` takes and gives, and whether a request asks for just that."""

from __future__ import annotations

from services.gateway.kserve.messages import (
    BINARY_OUTPUT,
    BINARY_OUTPUTS,
    Datatype,
    InferRequest,
    Parameters,
    TensorMetadata,
)
from shared.errors import InvalidInput


def _tensor(name: str, datatype: Datatype, *shape: int) -> TensorMetadata:
    return TensorMetadata(name=name, datatype=datatype, shape=list(shape))


INPUTS = (
    _tensor("points", "FP32", -1, 3),
    _tensor("depth", "UINT16", -1, -1),
    _tensor("intrinsics", "FP64", 3, 3),
    _tensor("depth_scale", "FP64", 1),
    _tensor("task", "BYTES", 1),
)
"""`points`, or `depth`, `intrinsics` and `depth_scale`; `task` here or among the parameters. Any
type of numbers will do."""
OUTPUTS = (
    _tensor("grasps", "FP64", -1, 9),
    _tensor("point_primitive", "INT16", -1),
    _tensor("point_region", "BOOL", -1),
    _tensor("primitives", "FP64", -1, 12),
    _tensor("report", "BYTES", 1),
)
_OF_HTTP = ("format", "pose_of", "stamp")
"""Parameters of POST /grasp that say how JSON is written."""


def require_known(asked: InferRequest) -> None:
    """Return if a request names inputs, outputs and parameters that there are.

    Raises
    ------
    InvalidInput
        Says which there are.
    """
    _require_names("input", [each.name for each in asked.inputs], INPUTS)
    _require_names("output", [each.name for each in asked.outputs], OUTPUTS)
    for name in _OF_HTTP:
        if name in asked.parameters:
            raise InvalidInput(
                f"{name} is a parameter of POST /grasp alone: here the answer is tensors",
                field=name,
            )
    flag(asked.parameters, BINARY_OUTPUTS)
    for each in asked.outputs:
        flag(each.parameters, BINARY_OUTPUT)


def flag(parameters: Parameters, name: str, default: bool = False) -> bool:
    """Return a parameter that is true or false.

    Raises
    ------
    InvalidInput
        It is something else.
    """
    value = parameters.get(name, default)
    if not isinstance(value, bool):
        raise InvalidInput(f"{name} must be true or false; found {value!r:.40}", field=name)
    return value


def _require_names(what: str, names: list[str], tensors: tuple[TensorMetadata, ...]) -> None:
    known = [each.name for each in tensors]
    for name in names:
        if name not in known or names.count(name) > 1:
            raise InvalidInput(
                f"there is no {what} {name!r}, or it is there twice; known are {', '.join(known)}",
                field=f"{what}s",
                found=names,
                allowed=known,
            )
