"""Parameters of the recovery: Table A.1 of the thesis, by name."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType

from shared.schemas.primitive import Preset


@dataclass(frozen=True)
class Parameters:
    """How superquadrics are recovered.

    Lengths and costs of the fit are in units of a tenth of the cloud's largest
    coordinate about its mean, as Liu et al. rescale it.

    Attributes
    ----------
    outlier_ratio : float
        Prior probability in (0, 1) that a point is no part of the superquadric.
    max_iterations : int
        Rounds of expectation and maximization at most.
    tolerance : float
        A weighted sum of squared distances below this is good enough.
    relative_tolerance : float
        A round that lowers the cost by a smaller share than this (of the new
        cost) has settled: time for a switch, or for the end.
    max_switches : int
        How often similar shapes are tried.
    adaptive_upper_bound : bool
        Bound each semi-axis by the points' reach along it.
    eps : float
        Reach of DBSCAN on the outliers, in metres.
    min_points : int
        Points within reach that make a DBSCAN core point, and the fewest that a
        further superquadric is fitted to.
    start_variance : float
        sigma^2 that the expectation starts with. Not in the table; the thesis
        runs all of it with 0.3.
    """

    outlier_ratio: float
    max_iterations: int
    tolerance: float
    relative_tolerance: float
    max_switches: int
    adaptive_upper_bound: bool
    eps: float
    min_points: int
    start_variance: float = 0.3


PRESETS: MappingProxyType[Preset, Parameters] = MappingProxyType(
    {
        "simulation": Parameters(
            outlier_ratio=0.965,
            max_iterations=18,
            tolerance=0.00468,
            relative_tolerance=0.867,
            max_switches=2,
            adaptive_upper_bound=False,
            eps=0.0131,
            min_points=100,
        ),
        "real_world": Parameters(
            outlier_ratio=0.996,
            max_iterations=18,
            tolerance=0.00430,
            relative_tolerance=0.804,
            max_switches=2,
            adaptive_upper_bound=True,
            eps=0.0397,
            min_points=150,
        ),
    }
)
