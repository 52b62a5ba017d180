"""The server as agents start it: as a process on the standard streams, and over HTTP."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import anyio
import httpx
from mcp import Client as Agent
from mcp import StdioServerParameters
from mcp.client.stdio import stdio_client
from mcp_types import CallToolResult

from services.mcp.app import create_server
from services.mcp.backend import Backend
from services.mcp.files import Root
from shared.client import Sparge
from tests.support.processes import CHECKOUT
from tests.support.relay import relay
from tests.support.samples import sample_path
from tests.support.serving import Client, serving


async def grasped(agent: Agent, file: str) -> dict[str, Any]:
    question = {"task": "pouring", "file": file, "max_grasps": 1}
    result = await agent.call_tool("grasp", question)
    assert isinstance(result, CallToolResult)
    assert not result.is_error, result.content
    assert isinstance(result.structured_content, dict)
    return result.structured_content


def test_over_the_standard_streams(backend: Client, tmp_path: Path) -> None:
    (tmp_path / "bottle.npz").write_bytes(sample_path("bottle").read_bytes())

    async def story(url: str) -> None:
        words = ["mcp", "--root", str(tmp_path), "--url", url]
        started = StdioServerParameters(
            command=sys.executable,
            args=["-c", "from services.cli import main; main()", *words],
            env={**os.environ, "PYTHONPATH": str(CHECKOUT)},
            cwd=tmp_path,
        )
        async with Agent(stdio_client(started)) as agent:
            found = await grasped(agent, "bottle.npz")
            assert found["found"]
            assert len(found["grasps"]) == 1

    with serving(relay(backend)) as url:
        anyio.run(story, url)


def test_over_http_on_the_loopback(backend: Client, tmp_path: Path) -> None:
    entered = []

    @contextmanager
    def there() -> Iterator[Sparge]:
        entered.append(True)
        yield Sparge(backend.request)

    server = create_server(Backend(there), Root(tmp_path))
    app = server.streamable_http_app(stateless_http=True, host="127.0.0.1")

    async def story(url: str) -> None:
        for _ in range(2):
            async with Agent(f"{url}/mcp") as agent:
                assert (await grasped(agent, "sample:bottle"))["found"]

    with serving(app) as url:  # type: ignore[arg-type]  # any ASGI application
        anyio.run(story, url)
        forged = httpx.post(f"{url}/mcp", json={}, headers={"Host": "robots-shop.example"})
        assert forged.status_code == 421
        page = httpx.post(f"{url}/mcp", json={}, headers={"Origin": "https://evil.example"})
        assert page.status_code == 403
    assert entered == [True], "one backend for all sessions"
