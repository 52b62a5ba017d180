"""The body of POST /grasp, by its content type -> one request."""

from __future__ import annotations

from fastapi import Request
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import UploadFile

from services.gateway import request as requests
from services.gateway.file_reader import FileReader
from services.gateway.settings import GatewaySettings
from shared.errors import InvalidInput, StageUnavailable, UnsupportedMediaType
from shared.wire import JSON, NPZ

FORM = "multipart/form-data"


async def parse_body(
    request: Request, settings: GatewaySettings, files: FileReader
) -> requests.GraspRequest:
    """Return the request that a body and its query hold.

    Raises
    ------
    SpargeError
        It cannot be read, or not in this content type.
    """
    media_type = request.headers.get("content-type", "").split(";", 1)[0].strip().lower()
    query = dict(request.query_params)
    limit = settings.max_unpacked_bytes
    if media_type == JSON:
        return await run_in_threadpool(requests.from_json, await request.body(), query, limit)
    if media_type == NPZ:
        return await run_in_threadpool(requests.from_npz, await request.body(), query, limit)
    if media_type == FORM:
        return await _parse_form(request, query, files)
    raise UnsupportedMediaType(
        f"content type {media_type or 'none'!r} is not read here; send {JSON}, {NPZ} or {FORM}",
        found=media_type,
        allowed=[JSON, NPZ, FORM],
    )


async def _parse_form(
    request: Request, query: dict[str, str], files: FileReader
) -> requests.GraspRequest:
    try:
        async with request.form(max_files=1, max_fields=32) as form:
            upload = form.get("file")
            if not isinstance(upload, UploadFile):
                raise InvalidInput("the form has no file field named 'file'", field="file")
            fields = {name: text for name, text in form.items() if isinstance(text, str)}
            body = await upload.read()
    except OSError as error:  # what is over a megabyte lies in a temporary file meanwhile
        raise StageUnavailable(
            f"the gateway has no place to keep the upload ({error.strerror})", stage="gateway"
        ) from error
    return await run_in_threadpool(
        requests.from_form, upload.filename or "", body, fields, query, files.read
    )
