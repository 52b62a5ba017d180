"""One inference: a body of the Open Inference Protocol -> a request for grasps -> its tensors."""

from __future__ import annotations

from typing import Any

import numpy as np
from fastapi import Request
from fastapi.responses import Response
from starlette.concurrency import run_in_threadpool

from services.gateway.grasping import Answered
from services.gateway.kserve.messages import BINARY_OUTPUTS, InferRequest
from services.gateway.kserve.model import require_known
from services.gateway.kserve.outputs import HEADER_LENGTH, write_outputs
from services.gateway.kserve.tensors import TensorReader
from services.gateway.request import GraspRequest, from_tensors
from services.gateway.settings import GatewaySettings
from shared.errors import InvalidInput, MalformedRequest, UnsupportedMediaType
from shared.wire.codec import read_json_object, validate


class Inference:
    """Reads one request and writes its answer.

    Parameters
    ----------
    settings : GatewaySettings
        Limits.
    """

    def __init__(self, settings: GatewaySettings) -> None:
        self._settings = settings
        self._asked: InferRequest | None = None

    async def parse(self, request: Request) -> GraspRequest:
        """Return the request for grasps that an HTTP request holds.

        Raises
        ------
        SpargeError
            It holds none.
        """
        encoding = request.headers.get("content-encoding", "identity")
        if encoding.lower() != "identity":
            raise UnsupportedMediaType(
                f"the content encoding {encoding[:40]!r} is not read here; send the body as it is",
                found=encoding[:40],
                allowed=["identity"],
            )
        length = request.headers.get(HEADER_LENGTH)
        return await run_in_threadpool(self._read, await request.body(), length)

    async def write(self, answered: Answered) -> Response:
        """Return the outputs that the request asked for."""
        assert self._asked is not None  # parse came first
        return await run_in_threadpool(write_outputs, self._asked, answered)

    def _read(self, body: bytes, length: str | None) -> GraspRequest:
        header, behind = _split(body, length)
        asked = validate(InferRequest, read_json_object(bytes(header)))
        require_known(asked)
        self._asked = asked
        reader = TensorReader(behind, self._settings.max_unpacked_bytes)
        held = {given.name: reader.read(given) for given in asked.inputs}
        reader.finish()
        parameters = {
            name: value for name, value in asked.parameters.items() if name != BINARY_OUTPUTS
        }
        if "task" in held:
            parameters["task"] = _one_text(held.pop("task"))
        if "depth_scale" in held:
            held["depth_scale"] = _one_number(held.pop("depth_scale"))
        return from_tensors(held, parameters)


def _split(body: bytes, length: str | None) -> tuple[memoryview, memoryview]:
    """Return the JSON of a body and what is behind it."""
    whole = memoryview(body)
    if length is None:
        return whole, whole[:0]
    if not (length.isascii() and length.isdigit() and len(length) < 16) or int(length) > len(body):
        raise MalformedRequest(
            f"{HEADER_LENGTH} must say how many of the body's {len(body)} bytes are JSON; found "
            f"{length[:40]!r}",
            field=HEADER_LENGTH,
        )
    return whole[: int(length)], whole[int(length) :]


def _one_text(texts: Any) -> str:
    if not isinstance(texts, list) or len(texts) != 1:
        raise InvalidInput("the input 'task' must be one element of BYTES", field="task")
    return bytes(texts[0]).decode(errors="replace")


def _one_number(numbers: Any) -> Any:
    flat = np.asarray(numbers).ravel()
    if len(flat) != 1 or flat.dtype.kind not in "iuf":
        raise InvalidInput("the input 'depth_scale' must be one number", field="depth_scale")
    return flat[0].item()
