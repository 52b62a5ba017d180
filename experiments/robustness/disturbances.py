"""What is done to a view."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from experiments.camera import StereoNoise
from experiments.framework import ShownView
from experiments.robustness.sizes import of_other_size

Mask = NDArray[np.bool_]
OCCLUDED = (0.20, 0.35, 0.50)
NOISE = (1, 2, 3, 4)
_AROUND_PX = 20


def with_noise(view: ShownView, factor: float, rng: np.random.Generator) -> ShownView:
    """Return the view as a stereo camera sees it whose noise is `factor` times the usual."""
    return replace(view, view=view.view.with_noise(StereoNoise().scaled(factor), rng))


def with_half_the_points(view: ShownView, rng: np.random.Generator) -> ShownView:
    """Return the view where every other pixel, at random, gives no return."""
    return view.without(rng.random(view.view.depth.shape) < 0.5)


def occluded(view: ShownView, share: float, rng: np.random.Generator) -> ShownView:
    """Return the view with a share of the object hidden from one side.

    Of the picture around the object, everything beyond a line of random
    direction gives no return, as behind the edge of something in front.
    """
    rows, columns = np.nonzero(view.view.on_object)
    angle = rng.uniform(0, 2 * np.pi)
    along = np.cos(angle) * columns + np.sin(angle) * rows
    edge = np.quantile(along, 1 - share)
    shape = view.view.depth.shape
    row, column = np.indices(shape)
    near = (
        (row >= rows.min() - _AROUND_PX)
        & (row <= rows.max() + _AROUND_PX)
        & (column >= columns.min() - _AROUND_PX)
        & (column <= columns.max() + _AROUND_PX)
    )
    return view.without(near & (np.cos(angle) * column + np.sin(angle) * row > edge))


Change = Callable[[ShownView, np.random.Generator], ShownView | None]
"""Returns None where a view cannot be disturbed in this way."""


def _unchanged(view: ShownView, _: np.random.Generator) -> ShownView:
    return view


def _noise(factor: int) -> Change:
    return lambda view, rng: with_noise(view, factor, rng)


def _occlusion(share: float) -> Change:
    return lambda view, rng: occluded(view, share, rng)


AS_IT_IS, OTHER_SIZE = "as it is", "other size"
CONDITIONS: Mapping[str, Change] = MappingProxyType(
    {
        AS_IT_IS: _unchanged,
        **{f"noise x{factor}": _noise(factor) for factor in NOISE},
        "half the points": with_half_the_points,
        **{f"{100 * share:.0f} % occluded": _occlusion(share) for share in OCCLUDED},
        OTHER_SIZE: of_other_size,
    }
)
"""What is done to a view, by name."""
