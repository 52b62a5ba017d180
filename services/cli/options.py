"""Options that several commands share."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import orjson
import typer


class Reasoning(StrEnum):
    """Which version of the reasoning decides."""

    v1 = "v1"
    v2 = "v2"


class Input(StrEnum):
    """What the points show."""

    scene = "scene"
    object = "object"


class Rehearsal(StrEnum):
    """Which grasps are tried in simulation before they are answered."""

    auto = "auto"
    never = "never"
    always = "always"


class LogLevel(StrEnum):
    """The least that is logged."""

    debug = "debug"
    info = "info"
    warning = "warning"
    error = "error"


ReasoningOption = Annotated[Reasoning, typer.Option(help="v1: rule per task; v2: affordances")]
InputOption = Annotated[Input, typer.Option("--input", help="scene: find the object first")]
GripperOption = Annotated[str, typer.Option(help="A name from GET /grippers")]
MaxGraspsOption = Annotated[int, typer.Option(min=0, max=100)]
RehearsalOption = Annotated[
    Rehearsal | None,
    typer.Option(help="Try grasps in simulation first; auto: where the best is in doubt"),
]
SeedOption = Annotated[int, typer.Option(min=0)]
_VIEWPOINT = typer.Option(help="Sensor position, as [x, y, z]")
ViewpointOption = Annotated[str, _VIEWPOINT]
MaybeViewpointOption = Annotated[str | None, _VIEWPOINT]
IntrinsicsOption = Annotated[str | None, typer.Option(help="3x3 pinhole matrix as JSON, for a PNG")]
DepthScaleOption = Annotated[float | None, typer.Option(help="Metres per unit of depth")]
UrlOption = Annotated[str | None, typer.Option(help="Ask this backend instead of starting one")]
HostOption = Annotated[str, typer.Option(help="Address to listen on")]
PortOption = Annotated[int, typer.Option(min=0, max=65535)]
LogLevelOption = Annotated[
    LogLevel | None, typer.Option(help="Instead of SPARGE_LOG_LEVEL; info without both")
]
InsecureOption = Annotated[
    bool, typer.Option("--insecure", help="Answer other machines without API keys")
]


def json_option(name: str, text: str | None) -> object:
    """Return what an option written as JSON says."""
    try:
        return None if text is None else orjson.loads(text)
    except orjson.JSONDecodeError:
        raise typer.BadParameter(
            f"--{name} must be JSON, as in [0, 0, 0]; found {text!r}"
        ) from None
