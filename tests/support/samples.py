"""The bundled views, as the messages' fields."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from shared.wire.npz import read_npz

SAMPLES = Path(__file__).resolve().parents[2] / "experiments" / "samples"


def sample_path(name: str) -> Path:
    """Return where the bundled view `name` lies."""
    return SAMPLES / f"{name}.npz"


def sample_view(name: str) -> dict[str, Any]:
    """Return `depth`, `intrinsics` and `depth_scale` of a bundled view."""
    held = read_npz(sample_path(name).read_bytes(), 10**8)
    return {
        "depth": held["depth"],
        "intrinsics": held["intrinsics"],
        "depth_scale": float(held["depth_scale"]),
    }
