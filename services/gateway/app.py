"""The gateway's application: the endpoints of the public contract."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from contextlib import asynccontextmanager
from typing import Any

import httpx
from fastapi import FastAPI, Request
from fastapi.responses import Response
from opentelemetry.trace import Tracer
from starlette.concurrency import run_in_threadpool
from starlette.middleware.cors import CORSMiddleware

from services.gateway import answer
from services.gateway.access import Access
from services.gateway.body import parse_body
from services.gateway.file_reader import FileReader
from services.gateway.formats import render
from services.gateway.grasping import Answered, Grasping
from services.gateway.knowledge import DOCUMENTED as KNOWLEDGE_ROUTES
from services.gateway.knowledge import serve_knowledge
from services.gateway.kserve import describe_kserve, error_body, serve_kserve
from services.gateway.memory import Memory
from services.gateway.metrics import GraspMetrics
from services.gateway.openapi import describe_grasp, describe_knowledge
from services.gateway.pipeline import Pipeline
from services.gateway.request import GraspRequest
from services.gateway.settings import STAGES, GatewaySettings
from shared.schemas.answer import EXPLANATION, KeptExplanation, RequestName
from shared.schemas.execution import EXECUTE
from shared.schemas.grasp import LIST_GRIPPERS
from shared.schemas.knowledge import ASK_QUESTION, LIST_QUESTIONS
from shared.schemas.route import Request as In
from shared.schemas.route import Response as Out
from shared.schemas.route import Route
from shared.schemas.rule import (
    ADD_AFFORDANCE,
    ADD_RULE,
    DELETE_AFFORDANCE,
    DELETE_RULE,
    LIST_RULES,
)
from shared.schemas.task import ADD_TASK, DELETE_TASK, LIST_AFFORDANCES, LIST_TASKS
from shared.service import Stage, StageClient
from shared.service.app import Health, create_base
from shared.service.connections import CONNECT_S, network
from shared.service.openapi import describe
from shared.service.secret import secret_headers
from shared.service.serve import serve
from shared.wire import JSON, NPZ

_HEALTH_TIMEOUT_S = 2.0
_PASSED_ON: tuple[Route[Any, Any], ...] = (
    LIST_TASKS,
    ADD_TASK,
    DELETE_TASK,
    LIST_AFFORDANCES,
    ADD_AFFORDANCE,
    DELETE_AFFORDANCE,
    LIST_RULES,
    ADD_RULE,
    DELETE_RULE,
    LIST_QUESTIONS,
    ASK_QUESTION,
    LIST_GRIPPERS,
    EXECUTE,
)


def create_app(
    settings: GatewaySettings | None = None,
    local: Mapping[str, Callable[[Tracer], Stage]] | None = None,
    network: Callable[[], httpx.AsyncBaseTransport] = network,
) -> FastAPI:
    """Return the gateway.

    Parameters
    ----------
    settings : GatewaySettings, optional
        Read from the environment when not given.
    local : mapping, optional
        Stages that have no URL, by name, each made with the tracer of its calls; the
        composition root gives those of this process.
    network : callable, optional
        Makes the transport to a stage that has a URL.

    Raises
    ------
    ValueError
        A stage has neither a URL nor is it local.
    InvalidInput
        The file of API keys cannot be read.
    """
    settings = settings or GatewaySettings()
    local = local or {}
    _require_all(settings, local)
    files = FileReader(settings)
    memory = Memory(settings.kept_explanations, settings.keep_explanations_s)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        try:
            yield
        finally:
            for stage in stages.values():
                await stage.close()
            await run_in_threadpool(files.close)

    async def ready() -> Health:
        all_health = await asyncio.gather(
            *(stage.health(_HEALTH_TIMEOUT_S) for stage in stages.values())
        )
        waiting = {
            name: health.details.get("error", health.status)
            for name, health in zip(stages, all_health, strict=True)
            if health.status != "ready"
        }
        failed = any(health.status == "failed" for health in all_health)
        return Health(
            status="failed" if failed else "starting" if waiting else "ready",
            service="gateway",
            details=waiting,
        )

    app = create_base(
        "gateway",
        "Where and how to grasp an object for a task, and the logic behind it",
        settings,
        lifespan=lifespan,
        ready=ready,
        guard=Access(settings),
        error_body=error_body,
    )

    def reach(name: str) -> Stage:
        url = settings.stage_url(name)
        if url is None:
            return local[name](app.state.tracer)
        http = httpx.AsyncClient(
            base_url=url,
            timeout=httpx.Timeout(None, connect=CONNECT_S),
            headers=secret_headers(settings.stage_secret),
            transport=network(),
        )
        return StageClient(name, http, app.state.tracer)  # nothing is opened yet

    stages = {name: reach(name) for name in STAGES}
    metrics = GraspMetrics(app.state.metrics.registry)
    pipeline = Pipeline(stages, settings, metrics)
    if settings.cors_origins:
        app.add_middleware(
            CORSMiddleware,
            allow_origins=settings.cors_origins,
            allow_methods=["GET", "POST", "DELETE"],
            allow_headers=["*"],
            expose_headers=["X-Request-ID", "Retry-After"],
        )

    grasping = Grasping(pipeline, settings, app.state.admission, memory, metrics)

    async def parse(request: Request) -> GraspRequest:
        return await parse_body(request, settings, files)

    @app.post("/grasp", operation_id="post_grasp", response_class=Response)
    async def grasp(request: Request) -> Response:
        async def write(answered: Answered) -> Response:
            return await _write(answered, request, settings)

        return await grasping.respond(request, parse, write)

    serve_kserve(app, grasping, ready, settings)

    async def explanation(asked: RequestName) -> KeptExplanation:
        return memory.recall(asked.request_id)

    serve(app, EXPLANATION, explanation, settings)
    for route in _PASSED_ON:
        serve(app, route, _forward(stages[route.service], route, settings), settings)
    serve_knowledge(app, stages["reasoning"], settings)
    describe(app, (EXPLANATION, *_PASSED_ON, *KNOWLEDGE_ROUTES))
    describe_knowledge(app)
    describe_grasp(app)
    describe_kserve(app)
    return app


def _require_all(settings: GatewaySettings, local: Mapping[str, object]) -> None:
    """Raise ValueError unless it is known where every stage is."""
    missing = [n for n in STAGES if settings.stage_url(n) is None and n not in local]
    if missing:
        names = ", ".join(f"SPARGE_GATEWAY_{name.upper()}_URL" for name in missing)
        raise ValueError(f"the gateway does not know where its stages are; set {names}")


def _forward(
    stage: Stage, route: Route[In, Out], settings: GatewaySettings
) -> Callable[[In], Awaitable[Out]]:
    deadline_s = settings.execution_deadline_s if route is EXECUTE else settings.deadline_s

    async def answer_from_stage(message: In) -> Out:
        return await stage.call(route, message, deadline_s)

    return answer_from_stage


async def _write(answered: Answered, request: Request, settings: GatewaySettings) -> Response:
    """Write an answer in the format and the content type that were asked for."""
    composed, outcome, parameters = answered.answer, answered.outcome, answered.parameters
    rendered = render(composed, outcome.grasps, parameters, outcome.gripper, settings)
    if NPZ in request.headers.get("accept", JSON):
        held = {**answered.arrays(), "grasps": rendered.grasps}
        return Response(
            await run_in_threadpool(answer.to_npz, held, rendered.answer), media_type=NPZ
        )
    return Response(rendered.answer.model_dump_json(), media_type=JSON)
