"""How far a recovered superquadric is from the one that the points were drawn from."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from shared.superquadric import Superquadric, radial_distance
from tests.services.primitive_recovery.clouds import overlap, random_superquadric, surface_points

Array = NDArray[np.float64]

NOISE = 0.0015
COLUMNS = ("surface mm", "overlap", "small %", "middle %", "large %", "centre mm", "e1", "e2")
SURFACE, OVERLAP, SMALL, MIDDLE, LARGE, CENTRE, E1, E2 = range(8)


def trials(
    recover: Callable[[Array, Array], Superquadric],
    kinds: tuple[str, ...],
    name: str,
    count: int = 24,
) -> dict[str, Array]:
    """Recover random superquadrics over the whole range of A.1.2, and print the errors.

    Parameters
    ----------
    recover : callable
        Takes points (n, 3) and the sensor's position (3,).
    kinds : tuple of str
        Of clouds of 1,500 points with noise of 1.5 mm: "noisy" (from all sides), "one view",
        "clutter" (600 points of the body, 900 anywhere around it).
    """
    rng = np.random.default_rng(1)
    found: dict[str, list[Array]] = {kind: [] for kind in kinds}
    for _ in range(count):
        body = random_superquadric(rng)
        whole = surface_points(body, 1500, rng)
        view = surface_points(body, 1500, rng, one_view=True)
        for kind in kinds:
            truth = {"noisy": whole, "one view": view, "clutter": whole[:600]}[kind]
            cloud = truth + NOISE * rng.normal(size=truth.shape)
            if kind == "clutter":
                middle = (whole.min(0) + whole.max(0)) / 2
                outliers = rng.uniform(-0.75, 0.75, (900, 3)) * np.ptp(whole, axis=0)
                cloud = np.vstack([cloud, middle + outliers])
            # One view is drawn as a camera far away along z sees it.
            sensor = np.array([body.position[0], body.position[1], -50.0])
            sensor = sensor if kind == "one view" else np.array(body.position)
            reference = view if kind == "one view" else whole
            found[kind].append(errors(body, recover(cloud, sensor), reference, rng))
    table = {kind: np.array(rows) for kind, rows in found.items()}
    print(f"\n{name}, {count} bodies, median [10th to 90th percentile]")
    print(f"{'':>10}" + "".join(f"{column:>22}" for column in COLUMNS))
    for kind, rows in table.items():
        low, median, high = np.nanpercentile(rows, (10, 50, 90), axis=0)
        cells = [
            f"{f'{m:.2f} [{a:.2f} {b:.2f}]':>22}" for a, m, b in zip(low, median, high, strict=True)
        ]
        print(f"{kind:>10}" + "".join(cells))
    return table


def errors(
    body: Superquadric, found: Superquadric, reference: Array, rng: np.random.Generator
) -> Array:
    """Return the errors (8,) of `COLUMNS`.

    The extents' are log ratios, smallest to largest, in percent. A body may be written with
    another of its axes as z; the exponents' errors are NaN where that is so.
    """
    surface = 1e3 * np.abs(radial_distance(found, reference)).mean()
    extents = np.log(np.sort(found.full_extents) / np.sort(body.full_extents))
    centre = 1e3 * np.linalg.norm(np.subtract(found.position, body.position))
    same = abs(float(found.rotation[:, 2] @ body.rotation[:, 2])) > np.cos(np.radians(15))
    exponents = np.subtract(found.exponents, body.exponents) if same else np.full(2, np.nan)
    shared = overlap(body, found, rng)
    return np.array([surface, shared, *(100 * extents), centre, *exponents])
