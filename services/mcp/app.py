"""The MCP server."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import anyio.to_thread
from mcp.server import MCPServer

from services.mcp.backend import Backend
from services.mcp.files import Root
from services.mcp.resources import add_resources
from services.mcp.tools import add_tools
from shared import __version__

INSTRUCTIONS = """\
SPaRGE looks at one depth view of an object and says which part to hold for a task (pouring, \
hammering, handover, ...), with 6-DOF gripper poses on that part and the reasons. Ask `tasks` \
for what it knows, `grasp` with a file or points and a task, `explain` for the conditions behind \
an answer. Units are metres, radians; poses are in the frame of the view; quaternions are \
[x, y, z, w]. Poses are proposals: a controller has to check reach, force and people."""


def create_server(backend: Backend, root: Root, *, read_only: bool = False) -> MCPServer:
    """Return the server; it starts `backend` when it is run.

    Parameters
    ----------
    root : Root
        Which files the tools may read.
    read_only : bool
        Leave out the tools that change the knowledge.
    """

    @asynccontextmanager
    async def lifespan(_: MCPServer) -> AsyncIterator[None]:
        running = backend.running()
        running.__enter__()
        try:
            yield
        finally:
            with anyio.CancelScope(shield=True):
                await anyio.to_thread.run_sync(running.__exit__, None, None, None)

    server: MCPServer = MCPServer(
        "sparge",
        title="SPaRGE",
        description="Task-specific grasps on unknown objects from one depth view",
        instructions=INSTRUCTIONS,
        version=__version__,
        lifespan=lifespan,
        log_level="WARNING",
    )
    add_tools(server, backend, root, read_only=read_only)
    add_resources(server, backend)
    return server
