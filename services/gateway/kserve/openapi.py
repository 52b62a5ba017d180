"""The OpenAPI description of inference, whose body FastAPI cannot see."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI

from services.gateway.kserve.messages import MODEL, InferError, InferRequest, InferResponse
from services.gateway.kserve.outputs import HEADER_LENGTH, OCTETS
from shared.service.openapi import add_models, error_responses
from shared.wire import JSON

_BINARY = {"schema": {"type": "string", "format": "binary"}}


def describe_kserve(app: FastAPI) -> None:
    """Add body and answers of `/v2/models/sparge/infer` to `app`'s document."""
    plain = app.openapi

    def openapi() -> dict[str, Any]:
        document = plain()
        operation = document["paths"][f"/v2/models/{MODEL}/infer"]["post"]
        if "requestBody" not in operation:
            add_models(document, [InferRequest, InferResponse, InferError])
            operation.update(_operation())
        return document

    app.openapi = openapi  # type: ignore[method-assign]  # FastAPI's documented extension point


def _operation() -> dict[str, Any]:
    reference = {"schema": {"$ref": "#/components/schemas/InferResponse"}}
    errors = error_responses()
    for each in errors.values():
        each["content"] = {JSON: {"schema": {"$ref": "#/components/schemas/InferError"}}}
    return {
        "summary": "POST /grasp as an inference of the Open Inference Protocol",
        "parameters": [
            {
                "name": HEADER_LENGTH,
                "in": "header",
                "required": False,
                "schema": {"type": "integer", "minimum": 0},
                "description": "how many bytes of the body are JSON; binary tensors follow it",
            }
        ],
        "requestBody": {
            "required": True,
            "content": {
                JSON: {"schema": {"$ref": "#/components/schemas/InferRequest"}},
                OCTETS: _BINARY,
            },
        },
        "responses": {
            "200": {"description": "The outputs", "content": {JSON: reference, OCTETS: _BINARY}},
            **errors,
        },
    }
