"""Triangles out of COLLADA files (.dae): what Open3D's wheels do not read.

A static subset of COLLADA 1.4 and 1.5: geometry, and the scene's nodes that
place it. Coordinates stay in the file's own units and axes. Materials, lines,
cameras, lights, joints and animations are passed over.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from shared.errors import InvalidInput

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MAX_DEPTH = 50
"""Of nodes in nodes; a scene that contains itself ends here."""


def read_collada(path: Path) -> tuple[Array, Indices]:
    """Return all triangles of a file's scene: vertices (V, 3) and faces (F, 3).

    A file without a scene gives its geometries as they are.

    Raises
    ------
    InvalidInput
        The file is no COLLADA, or holds something of which triangles cannot be made.
    """
    try:
        root = ElementTree.parse(path).getroot()
        return _Document(root).triangles()
    except (ElementTree.ParseError, ValueError, KeyError, IndexError, RecursionError) as error:
        raise InvalidInput(f"{path} cannot be read as COLLADA: {error}") from None


class _Document:
    """A parsed file; elements are found by id."""

    def __init__(self, root: ElementTree.Element) -> None:
        for element in root.iter():
            element.tag = element.tag.rpartition("}")[2]
        if root.tag != "COLLADA":
            raise ValueError(f"the root element is {root.tag!r}")
        self.root = root
        self.by_id = {element.get("id"): element for element in root.iter() if element.get("id")}

    def triangles(self) -> tuple[Array, Indices]:
        scene = self.root.find("scene/instance_visual_scene")
        if scene is None:
            placed = [(each, np.eye(4)) for each in self.root.iter("geometry")]
        else:
            placed = list(self._geometries(self._target(scene), np.eye(4), 0))
        vertices, faces, first = [np.empty((0, 3))], [np.empty((0, 3), dtype=np.int64)], 0
        for geometry, world_from_geometry in placed:
            for points, corners in _pieces(geometry, self.by_id):
                vertices.append(points @ world_from_geometry[:3, :3].T + world_from_geometry[:3, 3])
                mirrored = np.linalg.det(world_from_geometry[:3, :3]) < 0
                faces.append((corners[:, ::-1] if mirrored else corners) + first)
                first += len(points)
        return np.concatenate(vertices), np.concatenate(faces)

    def _geometries(
        self, node: ElementTree.Element, world_from_parent: Array, depth: int
    ) -> Iterator[tuple[ElementTree.Element, Array]]:
        if depth > MAX_DEPTH:
            raise ValueError(f"nodes lie more than {MAX_DEPTH} deep in one another")
        world_from_node = world_from_parent @ _transform(node)
        for child in node:
            if child.tag == "instance_geometry":
                yield self._target(child), world_from_node
            elif child.tag == "node":
                yield from self._geometries(child, world_from_node, depth + 1)
            elif child.tag == "instance_node":
                yield from self._geometries(self._target(child), world_from_node, depth + 1)

    def _target(self, instance: ElementTree.Element) -> ElementTree.Element:
        url = instance.get("url", "")
        if url.removeprefix("#") not in self.by_id:
            raise ValueError(f"{instance.tag} refers to {url!r}, which is not in the file")
        return self.by_id[url.removeprefix("#")]


def _transform(node: ElementTree.Element) -> Array:
    """Return parent_from_node (4, 4): the node's transformations, in their order."""
    total = np.eye(4)
    for child in node:
        step = np.eye(4)
        if child.tag == "matrix":
            step = _numbers(child).reshape(4, 4)
        elif child.tag == "translate":
            step[:3, 3] = _numbers(child)
        elif child.tag == "scale":
            step[:3, :3] = np.diag(_numbers(child))
        elif child.tag == "rotate":
            x, y, z, degrees = _numbers(child)
            axis = np.array([x, y, z]) / np.linalg.norm([x, y, z])
            step[:3, :3] = Rotation.from_rotvec(np.radians(degrees) * axis).as_matrix()
        elif child.tag in ("lookat", "skew"):
            raise ValueError(f"the transformation {child.tag!r} is not supported")
        total = total @ step
    return total


def _pieces(
    geometry: ElementTree.Element, by_id: dict[str | None, ElementTree.Element]
) -> Iterator[tuple[Array, Indices]]:
    """Yield the points and triangles of each primitive element of a geometry."""
    for element in geometry.iterfind("mesh/*"):
        if element.tag not in ("triangles", "polylist", "polygons", "trifans", "tristrips"):
            continue
        inputs = element.findall("input")
        stride = 1 + max(int(each.get("offset", 0)) for each in inputs)
        vertex = next(each for each in inputs if each.get("semantic") == "VERTEX")
        points = _positions(by_id[vertex.get("source", "").removeprefix("#")], by_id)
        runs = [_numbers(p).astype(np.int64)[int(vertex.get("offset", 0)) :: stride]
                for p in element.findall("p")]  # fmt: skip
        counts = element.find("vcount")
        if element.tag == "polylist" and runs and counts is not None:
            runs = np.split(runs[0], np.cumsum(_numbers(counts).astype(np.int64))[:-1])
        corners = [_triangulated(run, element.tag) for run in runs if len(run)]
        if corners:
            faces = np.concatenate(corners)
            if faces.min(initial=0) < 0 or faces.max(initial=-1) >= len(points):
                raise ValueError(f"{element.tag} refers to points that do not exist")
            yield points, faces


def _triangulated(run: Indices, kind: str) -> Indices:
    """Return triangles (F, 3) of a polygon, a fan, a strip or a list of triangles."""
    if kind == "triangles":
        return run.reshape(-1, 3)
    if kind == "tristrips":
        strip = np.column_stack([run[:-2], run[1:-1], run[2:]])
        strip[1::2] = strip[1::2, [1, 0, 2]]
        return strip
    return np.column_stack([np.full(max(len(run) - 2, 0), run[0]), run[1:-1], run[2:]])


def _positions(
    vertices: ElementTree.Element, by_id: dict[str | None, ElementTree.Element]
) -> Array:
    source = next(each for each in vertices.iter("input") if each.get("semantic") == "POSITION")
    holder = by_id[source.get("source", "").removeprefix("#")]
    accessor, floats = holder.find("technique_common/accessor"), holder.find("float_array")
    if floats is None:
        raise ValueError("a source of positions holds no float_array")
    stride = 3 if accessor is None else int(accessor.get("stride", 1))
    return _numbers(floats).reshape(-1, stride)[:, :3]


def _numbers(element: ElementTree.Element) -> Array:
    return np.array((element.text or "").split(), dtype=np.float64)
