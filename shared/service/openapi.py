"""The OpenAPI page of routes that read and write JSON and npz."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fastapi import FastAPI
from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

from shared.schemas.route import Route
from shared.service.envelope import ErrorEnvelope
from shared.wire import JSON, NPZ, Message

REFERENCE = "#/components/schemas/{model}"
"""How a document refers to one of its schemas."""

_ERRORS = {
    "400": "The body cannot be parsed",
    "401": "An API key is wanted and was not given, or is not known",
    "403": "The API key does not open this",
    "404": "There is none of that name",
    "408": "The body did not arrive in time",
    "409": "It does not fit what is known",
    "413": "The body is too large",
    "415": "The content type is not read here",
    "422": "Parsed, but not valid: says which field, what was found, what is allowed",
    "429": "Too many requests at once; Retry-After says when to ask again",
    "503": "Not ready, or a stage is down; Retry-After says when to ask again",
    "504": "The answer was not ready in time",
}
_OF_SOME = ("404", "409")
OF_EVERY_ROUTE = tuple(code for code in _ERRORS if code not in _OF_SOME)


def describe(app: FastAPI, routes: Sequence[Route[Any, Any]]) -> None:
    """Make `app`'s OpenAPI document tell the truth about `routes`."""
    plain = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            document = plain()
            add_models(document, [m for r in routes for m in (r.request, r.response)])
            for route in routes:
                operation = document["paths"][route.path][route.method.lower()]
                if route.method == "POST":
                    operation["requestBody"] = {"required": True, "content": content(route.request)}
                    operation.pop("parameters", None)
                else:
                    operation["parameters"] = _parameters(route)
                operation["responses"] = {
                    "200": {"description": "The answer", "content": content(route.response)},
                    **error_responses(_codes(route)),
                }
            app.openapi_schema = document
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign]  # FastAPI's documented extension point


def add_models(document: dict[str, Any], models: Sequence[type[BaseModel]]) -> None:
    """Add the JSON schemas of `models` to the document's components."""
    wanted = [(model, "validation") for model in dict.fromkeys([*models, ErrorEnvelope])]
    _, definitions = models_json_schema(
        wanted,  # type: ignore[arg-type]  # a list of (model, mode) pairs
        ref_template=REFERENCE,
    )
    schemas = document.setdefault("components", {}).setdefault("schemas", {})
    schemas.update(definitions["$defs"])


def content(message: type[Message]) -> dict[str, Any]:
    """Return the media types of a message: JSON by schema, npz by its arrays."""
    arrays = ", ".join(message.array_fields()) or "none"
    return {
        JSON: {"schema": {"$ref": f"#/components/schemas/{message.__name__}"}},
        NPZ: {
            "schema": {
                "type": "string",
                "format": "binary",
                "description": f"arrays: {arrays}; everything else as UTF-8 JSON in `message`",
            }
        },
    }


def error_responses(codes: Sequence[str] = OF_EVERY_ROUTE) -> dict[str, Any]:
    """Return the error answers, all of them the one envelope."""
    envelope = {JSON: {"schema": {"$ref": "#/components/schemas/ErrorEnvelope"}}}
    return {code: {"description": _ERRORS[code], "content": envelope} for code in codes}


def _codes(route: Route[Any, Any]) -> list[str]:
    """Return the statuses of the errors that a route may answer with."""
    possible = {*OF_EVERY_ROUTE}
    if "{" in route.path:
        possible.add("404")
    if route.changes:
        possible.add("409")
    return sorted(possible)


def _parameters(route: Route[Any, Any]) -> list[dict[str, Any]]:
    """Return what stands in the path and in the query string of a GET or DELETE."""
    schema = route.request.model_json_schema()
    required = schema.get("required", [])
    return [
        {"name": name, "in": "path", "required": True, "schema": each}
        if f"{{{name}}}" in route.path
        else {"name": name, "in": "query", "required": name in required, "schema": each}
        for name, each in schema.get("properties", {}).items()
    ]
