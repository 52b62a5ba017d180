"""The knowledge over HTTP in its own formats: Turtle, and SPARQL as the W3C has it."""

from __future__ import annotations

from typing import TypeVar

from fastapi import FastAPI, Request
from fastapi.responses import Response
from starlette.concurrency import run_in_threadpool

from services.gateway.settings import GatewaySettings
from shared.errors import MalformedRequest
from shared.schemas.knowledge import (
    EXPORT_KNOWLEDGE,
    IMPORT_KNOWLEDGE,
    QUERY_KNOWLEDGE,
    KnowledgeImport,
    SparqlQuery,
)
from shared.schemas.route import Nothing
from shared.service import Stage
from shared.service.serve import respond
from shared.wire import JSON, NPZ, Message, decode
from shared.wire.codec import validate

TURTLE = "text/turtle"
SPARQL_QUERY = "application/sparql-query"
SPARQL_RESULTS = "application/sparql-results+json"

M = TypeVar("M", bound=Message)

DOCUMENTED = (EXPORT_KNOWLEDGE, IMPORT_KNOWLEDGE, QUERY_KNOWLEDGE)


def serve_knowledge(app: FastAPI, reasoning: Stage, settings: GatewaySettings) -> None:
    """Add `/knowledge` and `/sparql` to `app`.

    Both take and give the messages of their routes as JSON and npz, too.
    """

    @app.get("/knowledge", operation_id="get_knowledge", response_class=Response)
    async def export(request: Request) -> Response:
        document = await reasoning.call(EXPORT_KNOWLEDGE, Nothing(), settings.deadline_s)
        accept = request.headers.get("accept", TURTLE)
        if TURTLE not in accept and (JSON in accept or NPZ in accept):
            return await respond(document, request)
        return Response(document.turtle, media_type=TURTLE)

    @app.post("/knowledge", operation_id="post_knowledge", response_class=Response)
    async def take_over(request: Request) -> Response:
        body = await request.body()
        if _media_type(request) == TURTLE:
            replace = request.query_params.get("replace", "false")
            wanted = validate(KnowledgeImport, {"turtle": _text(body), "replace": replace})
        else:
            wanted = await _decoded(KnowledgeImport, request, body, settings)
        imported = await reasoning.call(IMPORT_KNOWLEDGE, wanted, settings.deadline_s)
        return await respond(imported, request)

    @app.get("/sparql", operation_id="get_sparql", response_class=Response)
    async def ask(request: Request) -> Response:
        asked = validate(SparqlQuery, {"query": request.query_params.get("query", "")})
        return await answered(asked, request)

    @app.post("/sparql", operation_id="post_sparql", response_class=Response)
    async def ask_by_body(request: Request) -> Response:
        body = await request.body()
        if _media_type(request) == SPARQL_QUERY:
            return await answered(validate(SparqlQuery, {"query": _text(body)}), request)
        return await answered(await _decoded(SparqlQuery, request, body, settings), request)

    async def answered(asked: SparqlQuery, request: Request) -> Response:
        answer = await reasoning.call(QUERY_KNOWLEDGE, asked, settings.deadline_s)
        if NPZ in request.headers.get("accept", JSON):
            return await respond(answer, request)
        return Response(answer.model_dump_json(exclude_none=True), media_type=SPARQL_RESULTS)


async def _decoded(kind: type[M], request: Request, body: bytes, settings: GatewaySettings) -> M:
    media_type = request.headers.get("content-type", JSON)
    return await run_in_threadpool(decode, kind, body, media_type, settings.max_unpacked_bytes)


def _media_type(request: Request) -> str:
    return request.headers.get("content-type", JSON).split(";", 1)[0].strip().lower()


def _text(body: bytes) -> str:
    try:
        return body.decode()
    except UnicodeDecodeError:
        raise MalformedRequest("the body is not text in UTF-8") from None
