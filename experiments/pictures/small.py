"""Pictures that weigh little: the repository keeps them."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

Array = NDArray[np.float64]

QUALITY = 82
WHITE = 255


def figure(width_px: int, height_px: int) -> Figure:
    """Return an empty figure with a canvas and no window."""
    made = Figure(figsize=(width_px / 100, height_px / 100), dpi=100, facecolor="white")
    FigureCanvasAgg(made)
    return made


def save_figure(drawn: Figure, path: Path) -> int:
    """Write a figure as WebP; return its size in bytes."""
    buffer = BytesIO()
    drawn.savefig(buffer, format="png", metadata={"Software": None})
    return _save(Image.open(buffer).convert("RGB"), path)


def save_pixels(pixels: Array, path: Path) -> int:
    """Write an image (H, W, 4) of reds, greens, blues and alphas in [0, 1] on white."""
    flat = pixels[..., :3] * pixels[..., 3:] + (1 - pixels[..., 3:])
    return _save(Image.fromarray(np.round(WHITE * flat).astype(np.uint8), "RGB"), path)


def _save(image: Image.Image, path: Path) -> int:
    path.parent.mkdir(parents=True, exist_ok=True)
    image.save(path, "WEBP", quality=QUALITY, method=6)
    return path.stat().st_size
