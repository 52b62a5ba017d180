"""Errors of the backend as failed tool calls that an agent can read."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

from mcp_types import CallToolResult, TextContent

from shared.errors import SpargeError

P = ParamSpec("P")
T = TypeVar("T")


def telling(tool: Callable[P, T]) -> Callable[P, T]:
    """Return `tool` with every error of ours as its failed result: code, message, details."""

    @functools.wraps(tool)
    def told(*args: P.args, **kwargs: P.kwargs) -> Any:
        try:
            return tool(*args, **kwargs)
        except SpargeError as error:
            return failed(error)

    return told


def failed(error: SpargeError) -> CallToolResult:
    """Return the result of a call that failed, with the error as text and as data."""
    described = {"code": error.code, "message": error.message, "details": error.details}
    return CallToolResult(
        content=[TextContent(type="text", text=f"{error.code}: {error.message}")],
        structured_content={"error": described},
        is_error=True,
    )
