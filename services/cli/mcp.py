"""`sparge mcp`: tools for agents, over the standard streams or HTTP."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from services.cli.options import UrlOption


def mcp(
    root: Annotated[
        Path, typer.Option(help="Files are read below this folder only", file_okay=False)
    ] = Path(),
    url: UrlOption = None,
    read_only: Annotated[
        bool, typer.Option("--read-only", help="No tools that add or remove tasks")
    ] = False,
    http: Annotated[
        bool, typer.Option("--http", help="Streamable HTTP on the loopback, path /mcp")
    ] = False,
    port: Annotated[int, typer.Option(min=1, max=65535, help="With --http")] = 8200,
) -> None:
    """Serve the Model Context Protocol: the tools grasp, explain and tasks, for agents.

    Without --http it speaks over the standard streams, as agents start it.
    """
    from services.cli.ask import backend
    from services.mcp.app import create_server
    from services.mcp.backend import Backend
    from services.mcp.files import Root

    if not root.is_dir():
        raise typer.BadParameter(f"{root} is not a folder", param_hint="--root")
    served = create_server(Backend(partial(backend, url)), Root(root), read_only=read_only)
    if http:
        served.run("streamable-http", host="127.0.0.1", port=port, stateless_http=True)
    else:
        served.run("stdio")
