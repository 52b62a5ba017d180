"""`sparge`: grasp, annotate, serve, doctor; and the measuring stick, dataset and experiment."""

from __future__ import annotations

import os
import sys
from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.text import Text

from services.cli.annotate import annotate
from services.cli.dataset import dataset
from services.cli.doctor.command import doctor
from services.cli.experiment import experiment
from services.cli.grpc import grpc
from services.cli.key import key_commands
from services.cli.mcp import mcp
from services.cli.options import Input, LogLevel, Reasoning, json_option
from services.cli.rule import rule_commands
from services.cli.task import task_commands
from services.cli.view import view
from shared.errors import SpargeError

app = typer.Typer(
    help="Task-specific grasps on unknown objects from one depth view.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)


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
def grasp(
    file: Annotated[
        Path, typer.Argument(exists=True, dir_okay=False, help=".npz, .ply, .pcd, .xyz or .png")
    ],
    task: Annotated[str, typer.Option(help="What the object is for: pouring, hammering, ...")],
    reasoning: Annotated[Reasoning, typer.Option(help="v1: rule per task; v2: affordances")] = (
        Reasoning.v2
    ),
    kind: Annotated[
        Input, typer.Option("--input", help="scene: find the object first")
    ] = Input.scene,
    gripper: Annotated[str, typer.Option(help="A name from GET /grippers")] = "panda",
    max_grasps: Annotated[int, typer.Option(min=0, max=100)] = 5,
    seed: Annotated[int, typer.Option(min=0)] = 0,
    viewpoint: Annotated[str, typer.Option(help="Sensor position, as [x, y, z]")] = "[0, 0, 0]",
    intrinsics: Annotated[
        str | None, typer.Option(help="3x3 pinhole matrix as JSON, for a PNG")
    ] = None,
    depth_scale: Annotated[float | None, typer.Option(help="Metres per unit of depth")] = None,
    picture: Annotated[Path | None, typer.Option(help="Write a PNG of the answer here")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the JSON answer only")] = False,
    url: Annotated[
        str | None, typer.Option(help="Ask this backend instead of starting one")
    ] = None,
) -> None:
    """Find where and how to grasp the object in FILE for a task."""
    from services.cli.ask import Question, ask
    from services.cli.show import show
    from shared.client import headline

    console = Console(stderr=True)
    question = Question(
        file=file,
        task=task,
        parameters={
            "reasoning": reasoning.value,
            "input": kind.value,
            "gripper": gripper,
            "max_grasps": max_grasps,
            "seed": seed,
            "viewpoint": json_option("viewpoint", viewpoint),
            "intrinsics": json_option("intrinsics", intrinsics),
            "depth_scale": depth_scale,
        },
    )
    answered = ask(question, url, console)
    answer = answered.result.answer
    if as_json:
        print(answer.model_dump_json(indent=2))
    else:
        show(answer, Console())
    if picture is not None:
        from services.cli.picture import draw_answer

        points, assigned, region = answered.object_cloud()
        draw_answer(
            picture,
            points,
            assigned,
            region,
            answer.primitives,
            answered.result.grasps,
            answer.scene.up,
            f"{file.stem}: {headline(answer)}",
        )
        console.print(f"picture: {picture}", highlight=False)


@app.command()
def serve(
    host: Annotated[str, typer.Option(help="Address to listen on")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535)] = 8000,
    log_level: Annotated[
        LogLevel | None, typer.Option(help="Instead of SPARGE_LOG_LEVEL; info without both")
    ] = None,
    insecure: Annotated[
        bool, typer.Option("--insecure", help="Answer other machines without API keys")
    ] = False,
) -> None:
    """Serve the backend; stages without a URL in the environment run in this process.

    On another address than the loopback it starts only with API keys (`sparge key`).
    """
    import uvicorn

    from services.gateway.access import require_guarded
    from services.gateway.settings import GatewaySettings
    from services.wiring import create_app

    if log_level is not None:
        os.environ["SPARGE_LOG_LEVEL"] = log_level.value
    settings = GatewaySettings()
    if insecure:
        settings = settings.model_copy(update={"insecure": True})
    require_guarded(host, settings)
    uvicorn.run(
        partial(create_app, settings),
        factory=True,  # made once uvicorn has set up its logs, so that ours are the same
        host=host,
        port=port,
        timeout_graceful_shutdown=5,
    )
