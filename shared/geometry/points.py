"""Point sets (N, 3) in metres, and the depth images they come from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def points_from_depth(depth: NDArray[np.generic], intrinsics: Array, depth_scale: float) -> Array:
    """Return one point per pixel (H*W, 3), row-major, in the camera's optical frame.

    Parameters
    ----------
    depth : (H, W) array
        Distance along the optical axis, in units of `depth_scale`. Zero and
        non-finite values mean no return and give NaN points.
    intrinsics : (3, 3) array
        Pinhole matrix, in pixels.
    depth_scale : float
        Metres per unit of `depth`.
    """
    height, width = depth.shape
    z = depth.astype(np.float64) * depth_scale
    z[~(np.isfinite(z) & (z > 0))] = np.nan
    u = (np.arange(width) - intrinsics[0, 2]) / intrinsics[0, 0]
    v = (np.arange(height) - intrinsics[1, 2]) / intrinsics[1, 1]
    x = (u[None, :] - intrinsics[0, 1] / intrinsics[0, 0] * v[:, None]) * z
    return np.stack([x, v[:, None] * z, z], axis=-1).reshape(-1, 3)


def bounds(points: Array) -> tuple[Array, Array]:
    """Return lowest corner (D,) and extents (D,) of points (N, D).

    Column by column: NumPy takes ten times as long along the first axis.
    """
    columns = np.ascontiguousarray(points.T)
    low = columns.min(axis=1)
    return low, columns.max(axis=1) - low


def principal_axes(points: Array) -> tuple[Array, Array]:
    """Return variances (3,), descending, and axes (3, 3) as right-handed columns."""
    return principal_axes_of_centred(points - points.mean(axis=0))


def principal_axes_of_centred(centred: Array) -> tuple[Array, Array]:
    """Return `principal_axes` of points (N, 3) given about their mean."""
    values, vectors = np.linalg.eigh(centred.T @ centred / max(len(centred), 1))
    vectors = vectors[:, ::-1]
    if np.linalg.det(vectors) < 0:
        vectors[:, 2] *= -1
    return values[::-1].clip(min=0.0), vectors


def tail_signs(placed: Array) -> Array:
    """Return signs (D,) that turn axes to where the points reach farther, by the third moment.

    So that axes without a direction of their own move with the points, in any frame.

    Parameters
    ----------
    placed : (N, D) array
        Points about their mean, along the axes.
    """
    skew = np.einsum("ij,ij,ij->j", placed, placed, placed)
    return np.where(skew < 0, -1.0, 1.0)
