"""Gateways whose stages are elsewhere."""

from __future__ import annotations

from typing import Any

from services.gateway.settings import STAGES, GatewaySettings


def all_elsewhere(**settings: Any) -> GatewaySettings:
    """Return settings of a gateway all of whose stages have a URL."""
    urls = {f"{name}_url": "http://stage" for name in STAGES}
    return GatewaySettings.model_validate({**urls, **settings})
