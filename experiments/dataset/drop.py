"""How an object lies after a fall: it tips over the edges of its hull until it rests.

The quasi-static estimate of Goldberg, Mirtich, Zhuang, Craig, Carlisle and Canny
("Part pose statistics: estimators and experiments", IEEE Trans. Robotics and
Automation, 1999): the object is let down without momentum in a random
orientation, touches with a facet of its convex hull with the probability of
the facet's solid angle about the centre of mass, and tips from facet to facet
while that lowers it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, QhullError

from experiments.catalogue import CatalogueObject, RestingPose
from experiments.catalogue.mass import mass_properties
from shared.errors import InvalidInput

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

WOBBLE_DEG = 3.0
"""An object that tips over when it is tilted by this does not stay."""

COPLANAR_DEG = 0.05
"""Triangles of the hull that make one facet."""


@dataclass(frozen=True)
class Body:
    """What a fall needs to know of an object.

    Attributes
    ----------
    thing : CatalogueObject
        The object.
    hull : (V, 3) array
        Corners of its convex hull in its frame, metres.
    poses : tuple of RestingPose
        How it may come to rest, most probable first; the probabilities sum to one.
    """

    thing: CatalogueObject
    hull: Array
    poses: tuple[RestingPose, ...]


def body_of(thing: CatalogueObject, wobble_deg: float = WOBBLE_DEG) -> Body:
    """Return the object with its hull and its resting poses.

    Where the parts' volumes give no centre of mass inside the hull (a scan
    with holes), the hull's own centroid stands for it.

    Raises
    ------
    InvalidInput
        The object is flat, or its vertices are not finite.
    """
    vertices = thing.vertices
    try:
        hull = ConvexHull(vertices)
    except (QhullError, ValueError):
        raise InvalidInput(
            f"object {thing.name!r} has no volume to rest on: it is flat, or not finite"
        ) from None
    facets = _facets(hull, _centre(thing, hull))
    rest = _resting_facet(facets, wobble_deg)
    share = _sums(rest, facets.solid_angle / facets.solid_angle.sum(), len(rest))
    order = np.argsort(-share, kind="stable")
    poses = tuple(
        RestingPose((float(up[0]), float(up[1]), float(up[2])), float(share[index]))
        for index, up in zip(order, -facets.normal[order], strict=True)
        if share[index] > 0
    )
    return Body(thing, vertices[hull.vertices], poses)


def _centre(thing: CatalogueObject, hull: ConvexHull) -> Array:
    try:
        centre = mass_properties(thing).centre
    except ValueError:  # nothing enclosed
        centre = np.full(3, np.nan)
    inside = hull.equations[:, :3] @ centre + hull.equations[:, 3] < 0
    if bool(inside.all()):
        return centre
    corners = hull.points[hull.simplices] - hull.points[hull.vertices[0]]
    volume = np.abs(np.linalg.det(corners))
    centroid = (volume[:, None] * corners.sum(axis=1) / 4).sum(axis=0) / volume.sum()
    return np.asarray(hull.points[hull.vertices[0]] + centroid)


@dataclass(frozen=True)
class _Facets:
    """Facets (F) of a hull about the centre of mass, and the edges (E) between them.

    `height` is how high the centre of mass is when a facet lies on the ground.
    Each edge appears from both its facets: `inside` is the distance of the
    centre's foot from its line, negative when the foot lies beyond it, and
    `away` the foot's distance from the edge itself.
    """

    normal: Array
    height: Array
    solid_angle: Array
    edge_from: Indices
    edge_to: Indices
    inside: Array
    away: Array


def _facets(hull: ConvexHull, centre: Array) -> _Facets:
    corners = hull.points[hull.simplices] - centre
    normals = hull.equations[:, :3]
    angle = _solid_angle(corners)
    triangle = np.repeat(np.arange(len(corners)), 3)
    neighbour = hull.neighbors.ravel()
    turn = np.linalg.norm(np.cross(normals[triangle], normals[neighbour]), axis=1)
    flat = turn < np.radians(COPLANAR_DEG)
    links = coo_matrix((flat[flat], (triangle[flat], neighbour[flat])), shape=(len(corners),) * 2)
    count, component = connected_components(links, directed=False)
    facet = component.astype(np.intp)
    largest = np.zeros(count, dtype=np.intp)
    order = np.argsort(angle, kind="stable")
    largest[facet[order]] = order  # the last assignment wins
    normal = normals[largest]
    height = (normal @ (hull.points[hull.vertices] - centre).T).max(axis=1)

    border = facet[triangle] != facet[neighbour]
    one, other = facet[triangle[border]], facet[neighbour[border]]
    # scipy's neighbour k lies across from corner k
    ends = np.stack([np.roll(corners, -1, axis=1), np.roll(corners, -2, axis=1)], axis=2)
    start, end = np.moveaxis(ends.reshape(-1, 2, 3)[border], 1, 0)
    foot = normal[one] * height[one, None]
    outward = normal[other] - normal[one] * _dot(normal[other], normal[one])[:, None]
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    along = end - start
    length = np.maximum(_dot(along, along), 1e-30)
    nearest = start + along * np.clip(_dot(foot - start, along) / length, 0, 1)[:, None]
    return _Facets(
        normal=normal,
        height=height,
        solid_angle=_sums(facet, angle, count),
        edge_from=one,
        edge_to=other,
        inside=_dot(start - foot, outward),
        away=np.linalg.norm(nearest - foot, axis=1),
    )


def _resting_facet(facets: _Facets, wobble_deg: float) -> Indices:
    """Return for every facet (F,) the one on which the object ends."""
    height = facets.height
    lower = height[facets.edge_to] < height[facets.edge_from] - 1e-9
    near = facets.inside < np.tan(np.radians(wobble_deg)) * height[facets.edge_from]
    tips = np.flatnonzero(lower & near)
    beyond = facets.inside[tips] < 0
    order = tips[np.lexsort([facets.away[tips], ~beyond, facets.edge_from[tips]])]
    origin, first = np.unique(facets.edge_from[order], return_index=True)
    rest = np.arange(len(height))
    rest[origin] = facets.edge_to[order[first]]
    for index in np.argsort(height, kind="stable"):  # every step leads lower
        rest[index] = rest[rest[index]]
    return rest


def _solid_angle(corners: Array) -> Array:
    """Return the solid angle (F,) of triangles (F, 3, 3) seen from the origin.

    Van Oosterom and Strackee, 1983.
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    la, lb, lc = (np.linalg.norm(each, axis=1) for each in (a, b, c))
    triple = np.abs(_dot(a, np.cross(b, c)))
    below = la * lb * lc + _dot(a, b) * lc + _dot(a, c) * lb + _dot(b, c) * la
    return np.asarray(2 * np.arctan2(triple, below))


def _sums(index: Indices, values: Array, count: int) -> Array:
    """Return for every index below `count` the sum of the values that have it."""
    sums = np.zeros(count)
    np.add.at(sums, index, values)
    return sums


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", a, b))
