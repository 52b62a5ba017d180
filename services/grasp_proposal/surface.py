"""Local surface geometry: normals and the directions that a part runs in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from services.grasp_proposal.eigen import principal_frames
from services.grasp_proposal.neighbourhood import scatter_of_groups, scatter_within
from shared.geometry.rotation import unit

Array = NDArray[np.float64]

_NORMAL_NEIGHBOURS = 16
_CURVATURE_NEIGHBOURS = 24
_CURVED = 0.02
_PART_RADIUS = 0.035


@dataclass(frozen=True)
class LocalFrames:
    """Darboux frames at S surface points, and how the part around each runs.

    Attributes
    ----------
    points, normals : (S, 3) arrays
    curvature_axes : (S, 3) arrays
        Tangent direction in which the normal changes least (GPD's hand axis);
        on flat patches, the part axis.
    part_axes : (S, 3) array
        Longest direction of the surface within 35 mm.
    """

    points: Array
    normals: Array
    curvature_axes: Array
    part_axes: Array


def estimate_normals(points: Array, coarse: Array, viewpoint: Array | None) -> Array:
    """Return unit normals (N, 3) at points (N, 3) by PCA of the 16 nearest of `coarse`.

    The coarse cloud (M, 3) sets the scale: wide enough to average sensor noise.
    They point to the viewpoint, or away from the centroid where there is none.
    """
    _, near = cKDTree(coarse).query(points, k=min(_NORMAL_NEIGHBOURS, len(coarse)))
    scatters = scatter_of_groups(coarse, near.reshape(len(points), -1))
    normals = principal_frames(scatters)[1][:, :, 0]
    outwards = points - points.mean(axis=0) if viewpoint is None else viewpoint - points
    flip = np.einsum("ij,ij->i", normals, outwards) < 0
    return np.where(flip[:, None], -normals, normals)


def local_frames(at: Array, normal: Array, coarse: Array, coarse_normals: Array) -> LocalFrames:
    """Return the frames at points (S, 3) with normals (S, 3) of the surface `coarse` (M, 3)."""
    _, near = cKDTree(coarse).query(at, k=min(_CURVATURE_NEIGHBOURS, len(coarse)))
    around = coarse_normals[near]
    varying = np.einsum("ski,skj->sij", around, around) / near.shape[1]
    part = principal_frames(scatter_within(coarse, at, _PART_RADIUS))[1][:, :, 2]
    tangent = np.stack(_tangents(normal, part), axis=2)
    values, vectors = np.linalg.eigh(np.einsum("sia,sij,sjb->sab", tangent, varying, tangent))
    curvature = np.einsum("sia,sa->si", tangent, vectors[:, :, 0])
    flat = values[:, 1] - values[:, 0] < _CURVED
    return LocalFrames(at, normal, np.where(flat[:, None], tangent[:, :, 0], curvature), part)


def _tangents(normal: Array, hint: Array) -> tuple[Array, Array]:
    """Return two tangent directions, the first along `hint` where that is possible."""
    first = hint - normal * np.einsum("si,si->s", hint, normal)[:, None]
    along_normal = np.linalg.norm(first, axis=1) < 0.1
    fallback = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    fallback = fallback - normal * np.einsum("si,si->s", fallback, normal)[:, None]
    first = unit(np.where(along_normal[:, None], fallback, first))
    return first, np.cross(normal, first)
