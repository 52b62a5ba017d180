"""The OpenAPI description of POST /grasp, whose body FastAPI cannot see."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI

from services.gateway.request import GraspParameters
from shared.schemas.answer import GraspAnswer
from shared.schemas.formats import GraspNetAnswer, MoveItAnswer, PoseArrayAnswer
from shared.schemas.point_cloud2 import PointCloud2
from shared.schemas.scene import View
from shared.service.openapi import REFERENCE, add_models, error_responses
from shared.wire import JSON, NPZ

_NPZ_BODY = "arrays: points (N, 3), or depth (H, W), intrinsics (3, 3), depth_scale; others ignored"
_NPZ_ANSWER = (
    "arrays: point_primitive (N,) int16, point_region (N,) bool, primitives (P, 12), "
    "grasps (G, 9): x y z qx qy qz qw width score (with format=graspnet (G, 17)), "
    "report: the JSON answer as UTF-8"
)
_ANSWERS = (GraspAnswer, MoveItAnswer, GraspNetAnswer, PoseArrayAnswer)
"""By `format`."""


def describe_grasp(app: FastAPI) -> None:
    """Add parameters, bodies and answers of POST /grasp to `app`'s document."""
    plain = app.openapi

    def openapi() -> dict[str, Any]:
        document = plain()
        operation = document["paths"]["/grasp"]["post"]
        if "requestBody" not in operation:
            add_models(document, [GraspParameters, View, PointCloud2, *_ANSWERS])
            operation.update(_operation())
        return document

    app.openapi = openapi  # type: ignore[method-assign]  # FastAPI's documented extension point


def describe_knowledge(app: FastAPI) -> None:
    """Add what `/knowledge` and `/sparql` take and give beside JSON and npz."""
    plain = app.openapi

    def openapi() -> dict[str, Any]:
        document = plain()
        knowledge, sparql = document["paths"]["/knowledge"], document["paths"]["/sparql"]
        text: dict[str, Any] = {"schema": {"type": "string"}}
        knowledge["get"]["responses"]["200"]["content"]["text/turtle"] = text
        knowledge["post"]["requestBody"]["content"]["text/turtle"] = text
        sparql["post"]["requestBody"]["content"]["application/sparql-query"] = text
        answer = sparql["post"]["responses"]["200"]["content"]
        answer["application/sparql-results+json"] = answer[JSON]
        sparql["get"].update(
            summary=sparql["post"]["summary"],
            parameters=[{"name": "query", "in": "query", "required": True, **text}],
            responses=sparql["post"]["responses"],
        )
        return document

    app.openapi = openapi  # type: ignore[method-assign]  # FastAPI's documented extension point


def _operation() -> dict[str, Any]:
    parameters = GraspParameters.model_json_schema(ref_template=REFERENCE)["properties"]
    arrays = View.model_json_schema()["properties"]
    del arrays["viewpoint"]
    fields = {**arrays, **parameters}
    cloud = PointCloud2.model_json_schema(ref_template=REFERENCE)["properties"]
    return {
        "summary": "Where and how to grasp the object in this view for a task",
        "parameters": [
            {
                "name": name,
                "in": "query",
                "required": False,
                "schema": schema,
                "description": "also a JSON field or form field of this name",
            }
            for name, schema in parameters.items()
        ],
        "requestBody": {
            "required": True,
            "content": {
                JSON: {"schema": {"type": "object", "properties": {**fields, **cloud}}},
                NPZ: {"schema": {"type": "string", "format": "binary", "description": _NPZ_BODY}},
                "multipart/form-data": {"schema": _form(parameters)},
            },
        },
        "responses": {
            "200": {
                "description": "An answer; found = false is one, and says why",
                "content": {
                    JSON: {
                        "schema": {
                            "anyOf": [
                                {"$ref": f"#/components/schemas/{answer.__name__}"}
                                for answer in _ANSWERS
                            ]
                        }
                    },
                    NPZ: {
                        "schema": {"type": "string", "format": "binary", "description": _NPZ_ANSWER}
                    },
                },
            },
            **error_responses(),
        },
    }


def _form(parameters: dict[str, Any]) -> dict[str, Any]:
    upload = {
        "type": "string",
        "format": "binary",
        "description": ".ply, .pcd, .xyz, .npz or a 16-bit .png depth image",
    }
    beside_png = {"intrinsics": {"type": "string"}, "depth_scale": {"type": "number"}}
    return {
        "type": "object",
        "required": ["file"],
        "properties": {"file": upload, **beside_png, **parameters},
    }
