"""The scene in a mirror: physics knows neither left nor right."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.grasp_proposal.descriptor import PER_PROJECTION
from services.grasp_proposal.measures import MIRROR_X, MIRROR_Y

Single = NDArray[np.float32]


def mirrored(images: Single, numbers: Single, rng: np.random.Generator) -> tuple[Single, Single]:
    """Return images and numbers of the same grasps, each mirrored along x, y, both or neither."""
    images, numbers = images.copy(), numbers.copy()
    for axis, signs in ((0, MIRROR_X), (1, MIRROR_Y)):
        chosen = rng.random(len(images)) < 0.5
        images[chosen] = mirror_images(images[chosen], axis)
        numbers[chosen] *= signs.astype(np.float32)
    return images, numbers


def mirror_images(images: Single, axis: int) -> Single:
    """Return images (G, 15, 20, 20) of the scene mirrored along a hand's axis, 0 for x, 1 for y."""
    result = images.copy()
    for projection in range(3):
        shown = [other for other in range(3) if other != projection]
        first = PER_PROJECTION * projection
        block = result[:, first : first + PER_PROJECTION]
        if axis in shown:
            block = np.flip(block, axis=2 + shown.index(axis)).copy()
        block[:, axis] *= -1
        if axis == projection:
            block[:, 3] *= -1
        result[:, first : first + PER_PROJECTION] = block
    return result
