"""A small request that gets to each stage, and what an answer must be when the stage fails."""

from __future__ import annotations

from typing import Any

import httpx
import numpy as np

from services.gateway.settings import STAGES


def cup() -> list[list[float]]:
    """The near half of a cylinder, 60 mm wide and 100 mm high, 0.6 m before the camera."""
    angle, height = np.meshgrid(np.linspace(0, np.pi, 24), np.linspace(-0.05, 0.05, 20))
    rows = [0.03 * np.cos(angle), height, 0.6 - 0.03 * np.sin(angle)]
    points: list[list[float]] = np.stack(rows, axis=-1).reshape(-1, 3).tolist()
    return points


REQUESTS: dict[str, tuple[str, dict[str, Any]]] = {
    **dict.fromkeys(STAGES, ("/grasp", {"points": cup(), "task": "handover", "input": "object"})),
    "execution": (
        "/execute",
        {
            "pose": {"position": [0, 0, 0.6], "quaternion": [0, 0, 0, 1]},
            "width": 0.5,  # wider than the gripper opens: no physics
            "primitives": [[1, 1, 0.03, 0.03, 0.05, 0, 0, 0.6, 0, 0, 0, 1]],
            "up": [0, -1, 0],
        },
    ),
}
"""A request that gets to the stage."""


def failed(response: httpx.Response, status: int, code: str, stage: str) -> str:
    """Assert that an answer is this error and names the stage; return its message."""
    error = response.json()["error"]
    assert (response.status_code, error["code"]) == (status, code), error
    assert error["details"]["stage"] == stage
    assert stage in error["message"]
    assert error["request_id"] == response.headers["x-request-id"]
    if status == 503:
        assert int(response.headers["retry-after"]) > 0
    message: str = error["message"]
    return message
