"""`sparge`: grasp, annotate, serve, doctor; and the measuring stick, dataset and experiment."""

from __future__ import annotations

import os
import sys
from typing import Annotated

import typer
from rich.console import Console
from rich.text import Text

from services.cli.annotate import annotate
from services.cli.dataset import dataset
from services.cli.doctor.command import doctor
from services.cli.experiment import experiment
from services.cli.grasp import grasp
from services.cli.grpc import grpc
from services.cli.key import key_commands
from services.cli.mcp import mcp
from services.cli.options import HostOption, InsecureOption, LogLevelOption, PortOption
from services.cli.rule import rule_commands
from services.cli.task import task_commands
from services.cli.view import view
from shared.errors import SpargeError

app = typer.Typer(
    help="Task-specific grasps on unknown objects from one depth view.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)


app.command()(grasp)
app.command()(annotate)
app.command()(dataset)
app.command()(experiment)
app.command()(doctor)
app.command()(view)
app.command()(grpc)
app.command()(mcp)
app.add_typer(task_commands, name="task")
app.add_typer(rule_commands, name="rule")
app.add_typer(key_commands, name="key")


def main() -> None:
    """Run the command; an error of the tree ends it with one line and status 1."""
    try:
        app()
    except SpargeError as error:
        said = Text.assemble((error.code, "red"), ": ", error.message)
        Console(stderr=True).print(said, highlight=False)
        sys.exit(1)


@app.command()
def serve(
    host: HostOption = "127.0.0.1",
    port: PortOption = 8000,
    log_level: LogLevelOption = None,
    insecure: InsecureOption = False,
    grpc_port: Annotated[
        int | None, typer.Option(min=1, max=65535, help="Serve gRPC there as well")
    ] = None,
) -> None:
    """Serve the backend; stages without a URL in the environment run in this process.

    On another address than the loopback it starts only with API keys (`sparge key`).
    """
    import uvicorn
    from fastapi import FastAPI

    from services.gateway.access import require_guarded
    from services.gateway.settings import GatewaySettings
    from services.wiring import create_app

    if log_level is not None:
        os.environ["SPARGE_LOG_LEVEL"] = log_level.value
    settings = GatewaySettings()
    if insecure:
        settings = settings.model_copy(update={"insecure": True})
    require_guarded(host, settings)
    if grpc_port is not None:
        from services.grpc.app import require_free

        require_free(host, grpc_port)

    def create() -> FastAPI:
        app = create_app(settings)
        if grpc_port is None:
            return app
        from services.grpc.app import beside
        from services.grpc.settings import GrpcSettings

        open_to_all = GrpcSettings().model_copy(update={"insecure": settings.insecure})
        return beside(app, open_to_all, host, grpc_port)

    uvicorn.run(
        create,
        factory=True,  # made once uvicorn has set up its logs, so that ours are the same
        host=host,
        port=port,
        timeout_graceful_shutdown=5,
    )
