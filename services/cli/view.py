"""`sparge view`: the page in the browser."""

from __future__ import annotations

import importlib.util
import threading
import webbrowser
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from services.cli.options import (
    DepthScaleOption,
    IntrinsicsOption,
    MaybeViewpointOption,
    UrlOption,
    json_option,
)
from shared.errors import InvalidInput
from shared.loopback import is_loopback
from shared.settings import PROJECT_ROOT

SAMPLES = PROJECT_ROOT / "experiments" / "samples"


def view(
    places: Annotated[
        list[Path] | None,
        typer.Argument(
            exists=True, metavar="[FILE|FOLDER]...", help="Clouds; without any, the bundled views"
        ),
    ] = None,
    url: UrlOption = None,
    host: Annotated[str, typer.Option(help="Address to serve the page on")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=1, max=65535)] = 8080,
    viewpoint: MaybeViewpointOption = None,
    intrinsics: IntrinsicsOption = None,
    depth_scale: DepthScaleOption = None,
    opens: Annotated[bool, typer.Option("--open", help="Open the browser")] = False,
    insecure: Annotated[
        bool, typer.Option("--insecure", help="Serve the page to other machines, without keys")
    ] = False,
) -> None:
    """Look at answers in the browser: parts, region, grasps, reasons; teach and try."""
    console = Console(stderr=True)
    if importlib.util.find_spec("viser") is None:
        console.print(
            "viser not installed; please run: pip install 'sparge\\[view]'", highlight=False
        )
        raise typer.Exit(1)
    from services.cli.ask import backend
    from services.viewer.server import serving
    from services.viewer.sources import Sources

    if not is_loopback(host) and not insecure:
        raise InvalidInput(
            f"the page has no keys: everybody who reaches {host} could use it; "
            "say --insecure if that is meant",
            field="host",
            found=host,
        )
    sources = Sources(
        *(places or [SAMPLES]),
        intrinsics=json_option("intrinsics", intrinsics),
        depth_scale=depth_scale,
        viewpoint=json_option("viewpoint", viewpoint),
    )
    console.print("starting the stages" if url is None else f"asking {url}", highlight=False)
    with backend(url) as sparge, serving(sparge, sources, host, port) as page:
        console.print(f"the page is at {page}; Ctrl+C ends it", highlight=False)
        if opens:
            webbrowser.open(page)
        try:
            threading.Event().wait()
        except KeyboardInterrupt:
            console.print("bye")
