"""What the Open Inference Protocol exchanges, and how it tells errors.

Source: KServe, open-inference-protocol, `inference_rest.md`, and the binary tensor data extension.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, Field

from shared.errors import JsonObject, SpargeError
from shared.wire import Message

MODEL = "sparge"
PREFIX = "/v2"
BINARY = "binary_tensor_data"
"""The extension that is spoken here, as Triton and KServe call it."""
BINARY_SIZE = "binary_data_size"
BINARY_OUTPUT = "binary_data"
BINARY_OUTPUTS = "binary_data_output"

Datatype = Literal[
    "BOOL",
    "UINT8",
    "UINT16",
    "UINT32",
    "UINT64",
    "INT8",
    "INT16",
    "INT32",
    "INT64",
    "FP16",
    "FP32",
    "FP64",
    "BYTES",
]
Name = Annotated[str, Field(min_length=1, max_length=64)]
Parameters = Annotated[dict[str, str | bool | int | float], Field(max_length=64)]


class InferInput(Message):
    """A tensor of a request; `data` is flat or nested, or lies behind the JSON."""

    name: Name
    shape: Annotated[tuple[Annotated[int, Field(ge=0, lt=2**63)], ...], Field(max_length=8)]
    datatype: Datatype
    parameters: Parameters = Field(default_factory=dict)
    data: Any = None


class InferWanted(Message):
    """An output that is asked for."""

    name: Name
    parameters: Parameters = Field(default_factory=dict)


class InferRequest(Message):
    """The JSON of a request."""

    id: Annotated[str, Field(max_length=256)] | None = None
    parameters: Parameters = Field(default_factory=dict)
    inputs: Annotated[tuple[InferInput, ...], Field(min_length=1, max_length=16)]
    outputs: Annotated[tuple[InferWanted, ...], Field(max_length=16)] = ()


class InferOutput(BaseModel):
    """A tensor of an answer; `data` is flat, row-major, or lies behind the JSON."""

    name: str
    shape: list[int]
    datatype: Datatype
    parameters: dict[str, int] | None = None
    data: list[Any] | None = None


class InferResponse(BaseModel):
    """The JSON of an answer."""

    model_name: str
    id: str | None = None
    outputs: list[InferOutput]


class TensorMetadata(BaseModel):
    """A tensor that a model takes or gives; -1 stands for any length."""

    name: str
    datatype: Datatype
    shape: list[int]


class ModelMetadata(BaseModel):
    """What the model takes and gives."""

    name: str
    platform: str
    inputs: list[TensorMetadata]
    outputs: list[TensorMetadata]


class ServerMetadata(BaseModel):
    """Who answers."""

    name: str
    version: str
    extensions: list[str]


class ServerLive(BaseModel):
    """The server answers."""

    live: bool


class ServerReady(BaseModel):
    """Whether all stages are warm."""

    ready: bool


class ModelReady(BaseModel):
    """The same of the model."""

    name: str
    ready: bool


class InferError(BaseModel):
    """An error below /v2: `error` is a text there; the rest is the envelope's, beside it."""

    error: str
    code: str
    details: dict[str, object]
    request_id: str


def error_body(error: SpargeError, request_id: str, path: str) -> JsonObject:
    """Return the JSON body of an error: the protocol's below /v2, the envelope elsewhere."""
    whole = error.envelope(request_id)
    if path != PREFIX and not path.startswith(f"{PREFIX}/"):
        return whole
    told: JsonObject = whole["error"]
    return {"error": told.pop("message"), **told}
