"""Images of what is about each hand's closing region, for the network that scores it.

As in ten Pas et al., IJRR 2017 (15 channels): the points in a box about the closing region,
in the hand's frame, projected along its three axes; per projection the mean normal, the
mean height along the axis, and how much of the space along it the sensor could not see.
Other than there, the box follows the part's width, so that the pads are always at the same
place, it reaches beyond the pads, and the hidden space is looked up in the range image
instead of being cast from the points.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.closing_region import ClosingRegions
from services.grasp_proposal.visibility import TOLERANCE, SightMap
from services.grasp_proposal.workspace import Workspace
from shared.jit import kernel

Array = NDArray[np.float64]
Images = NDArray[np.float32]

SIZE = 20
"""Pixels along each side."""
CHANNELS = 15
"""Three projections, along x, y and z, of: normal x, y, z, height, hidden space."""
PER_PROJECTION = 5
HIDDEN_CELLS = 10
"""Along each side of the box, where hidden space is looked up; divides `SIZE`."""


def describe(workspace: Workspace, regions: ClosingRegions, sight: SightMap | None) -> Images:
    """Return the images (G, 15, 20, 20) of G closing regions.

    The pixels of a projection along x count along y, then z; along y: x, then z; along z:
    x, then y. Normals are means over a pixel's points, heights the mean coordinate along
    the projection in half sides of the box, -1 to 1; both are 0 where there is no point.
    Hidden is the share, 0 to 1, of the space above the support along the projection; 0
    without a `sight`.
    """
    images = np.zeros((len(regions.centre), CHANNELS, SIZE, SIZE), dtype=np.float32)
    _project(
        np.ascontiguousarray(workspace.points.T),
        np.ascontiguousarray(workspace.normals),
        np.ascontiguousarray(regions.centre),
        np.ascontiguousarray(regions.rotation),
        np.ascontiguousarray(regions.half),
        images,
    )
    if sight is not None:
        up = np.zeros(4)
        up[3] = np.inf
        if workspace.up is not None and workspace.support_offset is not None:
            up[:3], up[3] = workspace.up, workspace.support_offset
        _hide(
            np.ascontiguousarray(sight.nearest),
            np.ascontiguousarray(sight.view_from_work),
            np.array([*sight.viewpoint, *sight.corner, sight.cell]),
            up,
            np.ascontiguousarray(regions.centre),
            np.ascontiguousarray(regions.rotation),
            np.ascontiguousarray(regions.half),
            images,
        )
    return images


@kernel
def _project(
    columns: Array, normals: Array, centre: Array, rotation: Array, half: Array, images: Images
) -> None:
    """Fill normals and heights; `columns` (3, N) are the points' x, y and z."""
    px, py, pz = columns[0], columns[1], columns[2]
    number = columns.shape[1]
    local = np.empty((3, number))
    rows = np.empty(number, dtype=np.int64)
    sums = np.empty((3, SIZE, SIZE, PER_PROJECTION))
    for g in range(len(centre)):
        r, h, o = rotation[g], half[g], centre[g]
        a, b, c = r[0, 0] / h[0], r[1, 0] / h[0], r[2, 0] / h[0]
        shift = a * o[0] + b * o[1] + c * o[2]
        along = local[0]
        for n in range(number):  # nothing but sums of products: vector instructions
            along[n] = a * px[n] + b * py[n] + c * pz[n] - shift
        a, b, c = r[0, 1] / h[1], r[1, 1] / h[1], r[2, 1] / h[1]
        shift_y = a * o[0] + b * o[1] + c * o[2]
        count = np.uint64(0)
        for n in range(number):  # without branches: see placing.py
            x = along[n]
            rows[count], along[count] = n, x
            count += np.uint64(abs(x) < 1.0)
        d, e, f = r[0, 2] / h[2], r[1, 2] / h[2], r[2, 2] / h[2]
        shift_z = d * o[0] + e * o[1] + f * o[2]
        sums[:] = 0.0
        for i in range(count):
            n = rows[i]
            y = a * px[n] + b * py[n] + c * pz[n] - shift_y
            if abs(y) >= 1.0:
                continue
            z = d * px[n] + e * py[n] + f * pz[n] - shift_z
            if abs(z) >= 1.0:
                continue
            x = along[i]
            nx = r[0, 0] * normals[n, 0] + r[1, 0] * normals[n, 1] + r[2, 0] * normals[n, 2]
            ny = r[0, 1] * normals[n, 0] + r[1, 1] * normals[n, 1] + r[2, 1] * normals[n, 2]
            nz = r[0, 2] * normals[n, 0] + r[1, 2] * normals[n, 1] + r[2, 2] * normals[n, 2]
            u = min(int((x + 1.0) / 2.0 * SIZE), SIZE - 1)
            v = min(int((y + 1.0) / 2.0 * SIZE), SIZE - 1)
            w = min(int((z + 1.0) / 2.0 * SIZE), SIZE - 1)
            for pixel, height in (
                (sums[0, v, w], x),
                (sums[1, u, w], y),
                (sums[2, u, v], z),
            ):
                pixel[0] += nx
                pixel[1] += ny
                pixel[2] += nz
                pixel[3] += height
                pixel[4] += 1.0
        for p in range(3):
            for i in range(SIZE):
                for j in range(SIZE):
                    points = sums[p, i, j, 4]
                    if points > 0.0:
                        for k in range(4):
                            images[g, PER_PROJECTION * p + k, i, j] = sums[p, i, j, k] / points


@kernel
def _hide(
    nearest: Array,
    view_from_work: Array,
    map_numbers: Array,
    up: Array,
    centre: Array,
    rotation: Array,
    half: Array,
    images: Images,
) -> None:
    """Fill the hidden space, as `SightMap.depth_behind` knows it.

    `map_numbers` are the viewpoint, the corner and the cell of the map; `up` is the up
    direction and the support's offset.
    """
    step = SIZE // HIDDEN_CELLS
    cell = 1.0 / map_numbers[5]
    rows, columns = nearest.shape
    share = np.float32(1.0 / HIDDEN_CELLS)
    start, local = np.empty(3), np.empty((3, 3))
    for g in range(len(centre)):
        height, rise = up[3], np.zeros(3)
        for i in range(3):
            height += up[i] * centre[g, i]
            start[i] = 0.0
            for k in range(3):
                start[i] += view_from_work[i, k] * (centre[g, k] - map_numbers[k])
                rise[i] += up[k] * rotation[g, k, i] * half[g, i]
                local[i, k] = 0.0
                for m in range(3):
                    local[i, k] += view_from_work[i, m] * rotation[g, m, k] * half[g, k]
        for i in range(HIDDEN_CELLS):
            x = (2.0 * i + 1.0) / HIDDEN_CELLS - 1.0
            for j in range(HIDDEN_CELLS):
                y = (2.0 * j + 1.0) / HIDDEN_CELLS - 1.0
                for k in range(HIDDEN_CELLS):
                    z = (2.0 * k + 1.0) / HIDDEN_CELLS - 1.0
                    if height + rise[0] * x + rise[1] * y + rise[2] * z <= 0.0:
                        continue
                    ahead = start[2] + local[2, 0] * x + local[2, 1] * y + local[2, 2] * z
                    if ahead <= 1e-6:
                        continue
                    across = start[0] + local[0, 0] * x + local[0, 1] * y + local[0, 2] * z
                    down = start[1] + local[1, 0] * x + local[1, 1] * y + local[1, 2] * z
                    u = np.floor((across / ahead - map_numbers[3]) * cell)
                    v = np.floor((down / ahead - map_numbers[4]) * cell)
                    if not (0 <= u < columns and 0 <= v < rows):
                        continue
                    if ahead - nearest[int(v), int(u)] > TOLERANCE:
                        images[g, 4, step * j, step * k] += share
                        images[g, 9, step * i, step * k] += share
                        images[g, 14, step * i, step * j] += share
        for channel in (4, 9, 14):
            for i in range(SIZE):
                for j in range(SIZE):
                    images[g, channel, i, j] = images[
                        g, channel, i // step * step, j // step * step
                    ]
