"""The endpoints below /v2."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse, Response

from services.gateway.grasping import Grasping
from services.gateway.kserve.infer import Inference
from services.gateway.kserve.messages import (
    BINARY,
    MODEL,
    InferError,
    ModelMetadata,
    ModelReady,
    ServerLive,
    ServerMetadata,
    ServerReady,
)
from services.gateway.kserve.model import INPUTS, OUTPUTS
from services.gateway.settings import GatewaySettings
from shared import __version__
from shared.service.app import Health

_REFUSED: dict[int | str, dict[str, Any]] = {
    401: {"model": InferError, "description": "An API key is wanted, or another one"},
    403: {"model": InferError, "description": "The API key does not open this"},
    429: {"model": InferError, "description": "The API key asks too often"},
}


def serve_kserve(
    app: FastAPI,
    grasping: Grasping,
    ready: Callable[[], Awaitable[Health]],
    settings: GatewaySettings,
) -> None:
    """Add `/v2` to `app`; inference goes the way of POST /grasp, its queue included."""

    @app.get("/v2/health/live", tags=["kserve"], summary="The process answers")
    async def live() -> ServerLive:
        return ServerLive(live=True)

    @app.get(
        "/v2/health/ready",
        tags=["kserve"],
        summary="Warm and able to work",
        response_model=ServerReady,
        responses={503: {"model": ServerReady, "description": "Not yet, or not any more"}},
    )
    async def server_ready() -> Response:
        is_ready = (await ready()).status == "ready"
        return _told(ServerReady(ready=is_ready).model_dump(), is_ready)

    @app.get(
        f"/v2/models/{MODEL}/ready",
        tags=["kserve"],
        summary="The model is warm and able to work",
        response_model=ModelReady,
        responses={503: {"model": ModelReady, "description": "Not yet, or not any more"}},
    )
    async def model_ready() -> Response:
        is_ready = (await ready()).status == "ready"
        return _told(ModelReady(name=MODEL, ready=is_ready).model_dump(), is_ready)

    @app.get("/v2", tags=["kserve"], summary="Which server this is", responses=_REFUSED)
    async def server() -> ServerMetadata:
        return ServerMetadata(name=MODEL, version=__version__, extensions=[BINARY])

    @app.get(
        f"/v2/models/{MODEL}",
        tags=["kserve"],
        summary="What the model takes and gives",
        responses=_REFUSED,
    )
    async def model() -> ModelMetadata:
        return ModelMetadata(
            name=MODEL, platform="sparge", inputs=list(INPUTS), outputs=list(OUTPUTS)
        )

    @app.post(
        f"/v2/models/{MODEL}/infer",
        tags=["kserve"],
        operation_id="post_v2_infer",
        response_class=Response,
    )
    async def infer(request: Request) -> Response:
        inference = Inference(settings)
        return await grasping.respond(request, inference.parse, inference.write)


def _told(body: dict[str, Any], is_ready: bool) -> Response:
    return JSONResponse(body, status_code=200 if is_ready else 503)
