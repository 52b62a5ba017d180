"""What may be given as a view: an array, a mapping of arrays, or a file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shared.errors import InvalidInput
from shared.geometry.points import points_from_depth
from shared.schemas.scene import View

ViewLike = ArrayLike | Mapping[str, ArrayLike] | os.PathLike[str]
"""Points (N, 3) in metres; or a depth image (H, W) with `intrinsics` beside it; or a mapping with
`points`, or with `depth`, `intrinsics`, `depth_scale`; or the path of a file."""


def arrays_of(
    view: ArrayLike | Mapping[str, ArrayLike],
    intrinsics: ArrayLike | None,
    depth_scale: float | None,
) -> dict[str, ArrayLike]:
    """Return the arrays that the body of a request holds.

    Raises
    ------
    InvalidInput
        Neither a cloud nor a depth image, by its shape.
    """
    beside = {"intrinsics": intrinsics, "depth_scale": depth_scale}
    given = {name: value for name, value in beside.items() if value is not None}
    if isinstance(view, Mapping):
        return {**view, **given}
    array = _numbers(view)
    if intrinsics is not None:
        return {"depth": array, **given}
    if array.ndim == 2 and array.shape[1] == 3:
        return {"points": array, **given}
    raise InvalidInput(
        f"a view is an array of points (N, 3), or a depth image (H, W) with intrinsics; "
        f"found an array of shape {array.shape} without them",
        field="view",
        found=list(array.shape),
    )


def points_of(view: View) -> NDArray[np.float64]:
    """Return the points (N, 3), in metres, that answers about a view speak of.

    Those of a depth image are row-major, zero where nothing came back.
    """
    if view.points is not None:
        return view.points
    assert view.depth is not None
    assert view.intrinsics is not None
    return points_from_depth(view.depth, view.intrinsics, view.depth_scale or 1.0)


def _numbers(view: ArrayLike) -> NDArray[Any]:
    try:
        array = np.asarray(view)
    except ValueError as error:
        raise InvalidInput(f"the view is no array: {error}", field="view") from None
    if array.dtype.kind not in "fiu":
        raise InvalidInput(
            f"the view holds {array.dtype}, expected numbers; a file is given as a pathlib.Path",
            field="view",
            found=str(array.dtype),
        )
    return array
