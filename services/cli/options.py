"""Options that several commands share."""

from __future__ import annotations

from enum import StrEnum

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


class LogLevel(StrEnum):
    """The least that is logged."""

    debug = "debug"
    info = "info"
    warning = "warning"
    error = "error"


def json_option(name: str, text: str | None) -> object:
    """Return what an option written as JSON says."""
    try:
        return None if text is None else orjson.loads(text)
    except orjson.JSONDecodeError:
        raise typer.BadParameter(
            f"--{name} must be JSON, as in [0, 0, 0]; found {text!r}"
        ) from None
