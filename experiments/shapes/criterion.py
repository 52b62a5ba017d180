"""The stated criterion: which of three names a superquadric has.

The name of the ideal body that it overlaps most by volume (`overlap.py`), out of
those that a viewer would take it for:

- a box, upright or turned by 45 degrees about z;
- an elliptic cylinder about the superquadric's own z;
- an elliptic cylinder about its x or y, if seen along that axis it looks round, and
  if it is a rod or a disc: `ROD` times as long as thick, or more;
- a ball, if it is alike in size: its longest axis at most `ALIKE` times its shortest.

"Looks round": of its outline's rectangle, ellipse and rhombus, the ellipse has the
largest IoU with it. The three have the outline's own extents, the rhombus those
across its sides. Both comparisons have closed forms, since the area of a
superellipse has (Jaklic, Leonardis, Solina 2000, Eq. 2.50).

"Alike": an ellipse with these axes has a larger IoU with the circle of its own area
than a circle has with its square. Eq. A.6 of the thesis has 1.3 here.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.special import gamma

from experiments.shapes.overlap import overlaps

Array = NDArray[np.float64]
Labels = NDArray[np.int64]

CLASSES = ("cuboid", "cylinder", "sphere")

ALIKE = math.tan(math.pi**2 / (2 * (4 + math.pi))) ** -2
"""1.46: an ellipse of axes 1 : r meets the circle of its area with IoU 4 t / (2 pi - 4 t),
tan t = r^(-1/2); equal to pi / 4, a circle's IoU with its square, at this r."""

ROD = 2.0
"""Longest over shortest axis from which on a lying cylinder is taken for one: the least ratio
of a part to wrap the hand around in the thesis's rules (A.2, `min_ratio`)."""

PERCEPTION = 0.05
"""Standard deviation of what a viewer sees: exponents, and logarithms of sizes."""

_EXPONENTS = (0.1, 2.0)


def superellipse_area(exponent: float) -> float:
    """Return the area of |x|^(2/e) + |y|^(2/e) <= 1: 4 at e = 0, pi at 1, 2 at 2."""
    return float(4 * gamma(1 + exponent / 2) ** 2 / gamma(1 + exponent))


def looks_round(exponent: float) -> bool:
    """Tell whether a superellipse is nearer to its ellipse than to its square or rhombus."""
    if exponent <= 1:
        # Ellipse within outline within square: pi / A against A / 4.
        return superellipse_area(exponent) ** 2 < 4 * math.pi
    # Outline within ellipse and within rhombus of half-diagonal d: A / pi against A / 2 d^2.
    return bool(2 * (2 ** (1 - exponent / 2)) ** 2 > math.pi)


def scores(parameters: Array) -> Array:
    """Return how well [e1, e2, a1, a2, a3] (5,) goes as cuboid, cylinder, sphere: (3,) in 0..1."""
    found = overlaps(parameters)
    ratio = float(parameters[2:].max() / parameters[2:].min())
    lies = ratio >= ROD and looks_round(float(parameters[0]))
    cylinder = max(found.cylinder, found.lying_cylinder) if lies else found.cylinder
    return np.array([found.box, cylinder, found.ball if ratio <= ALIKE else 0.0])


def name(parameters: Array) -> int:
    """Return the index in CLASSES of the name of [e1, e2, a1, a2, a3] (5,)."""
    return int(np.argmax(scores(parameters)))


def names(parameters: Array) -> Labels:
    """Return the names (N,) of superquadrics (N, 5)."""
    return np.array([name(row) for row in parameters], dtype=np.int64)


def perceived(parameters: Array, rng: np.random.Generator, spread: float = PERCEPTION) -> Array:
    """Return superquadrics (N, 5) as a viewer sees them: a little off.

    Near a border between two names a viewer says now one, now the other; the
    share of each is what a probability of the classifier means.
    """
    seen = parameters.copy()
    seen[:, :2] = (seen[:, :2] + rng.normal(0, spread, (len(seen), 2))).clip(*_EXPONENTS)
    seen[:, 2:] *= np.exp(rng.normal(0, spread, (len(seen), 3)))
    return seen
