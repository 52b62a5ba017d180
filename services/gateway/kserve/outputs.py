"""The outputs of an inference, as JSON and as bytes behind it."""

from __future__ import annotations

from typing import Any

import numpy as np
import orjson
from fastapi.responses import Response

from services.gateway.grasping import Answered
from services.gateway.kserve.messages import (
    BINARY_OUTPUT,
    BINARY_OUTPUTS,
    BINARY_SIZE,
    MODEL,
    InferRequest,
)
from services.gateway.kserve.model import OUTPUTS, flag
from services.gateway.kserve.tensors import pack, pack_text
from shared.wire import JSON

HEADER_LENGTH = "Inference-Header-Content-Length"
OCTETS = "application/octet-stream"


def write_outputs(asked: InferRequest, answered: Answered) -> Response:
    """Return the outputs that were asked for; all of them, if none was named."""
    by_default = flag(asked.parameters, BINARY_OUTPUTS)
    wanted = {each.name: flag(each.parameters, BINARY_OUTPUT, by_default) for each in asked.outputs}
    if not wanted:
        wanted = {each.name: by_default for each in OUTPUTS}
    tensors = answered.arrays()
    outputs: list[dict[str, Any]] = []
    behind: list[bytes] = []
    for name, binary in wanted.items():
        output, packed = _output(name, tensors.get(name), answered, binary)
        outputs.append(output)
        behind.append(packed)
    said: dict[str, Any] = {"model_name": MODEL, "outputs": outputs}
    if asked.id is not None:
        said["id"] = asked.id
    header = orjson.dumps(said, option=orjson.OPT_SERIALIZE_NUMPY)
    if not any(wanted.values()):
        return Response(header, media_type=JSON)
    length = {HEADER_LENGTH: str(len(header))}
    return Response(b"".join([header, *behind]), media_type=OCTETS, headers=length)


def _output(
    name: str, array: np.ndarray | None, answered: Answered, binary: bool
) -> tuple[dict[str, Any], bytes]:
    """Return one output and its bytes behind the JSON; without an array it is the report."""
    output: dict[str, Any] = {
        "name": name,
        "datatype": next(each.datatype for each in OUTPUTS if each.name == name),
        "shape": [1] if array is None else list(array.shape),
    }
    text = answered.answer.model_dump_json() if array is None else ""
    if binary:
        packed = pack_text(text.encode()) if array is None else pack(array)
        output["parameters"] = {BINARY_SIZE: len(packed)}
        return output, packed
    output["data"] = [text] if array is None else np.ascontiguousarray(array).ravel()
    return output, b""
