"""The `Server-Timing` header (W3C Server Timing): where an answer's time went."""

from __future__ import annotations

from collections.abc import Mapping

SERVER_TIMING = "Server-Timing"


def server_timing(timings_ms: Mapping[str, float]) -> str:
    """Return the header's value; names must be tokens of HTTP, as Python names are."""
    return ", ".join(f"{name};dur={spent:.1f}" for name, spent in timings_ms.items())
