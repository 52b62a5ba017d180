"""One superquadric from one cloud: the EMS loop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.ems.bounds import current_bounds
from services.primitive_recovery.ems.expectation import OUTLIER_PROBABILITY, inlier_probability
from services.primitive_recovery.ems.kernels import UNKNOWNS
from services.primitive_recovery.ems.maximization import maximize
from services.primitive_recovery.ems.start import THINNEST, FitFrame, first_guess
from services.primitive_recovery.ems.state import State
from services.primitive_recovery.ems.switch import switch
from shared.deadline import check_deadline
from shared.schemas.primitive import EmsParameters
from shared.superquadric import Superquadric

Array = NDArray[np.float64]

START_VARIANCE = 0.3
"""sigma^2 that the expectation starts with. Not in Table A.1; the thesis runs all of it so."""

_LEAST_VARIANCE = 1e-6
_LEAST_ITERATIONS = 12
"""Rounds before a settled fit may end. With the relative tolerances of Table A.1 nearly
every round counts as settled, while a fit that began on the middle of a long part
still grows along it by a few percent a round."""


@dataclass(frozen=True)
class Fit:
    """A recovered superquadric and what the points say to it.

    Attributes
    ----------
    superquadric : Superquadric
        In the points' frame, in metres.
    probability : (N,) array
        Of each point to be an inlier; one for all where outliers cannot be told.
    distances : (N,) array
        Signed radial distances in metres.
    """

    superquadric: Superquadric
    probability: Array
    distances: Array


def recover_one(
    points: Array,
    parameters: EmsParameters,
    viewpoint: Array,
    fit_points: int,
    rng: np.random.Generator,
) -> Fit:
    """Fit a superquadric to points by expectation, maximization and switch.

    Liu, Wu, Ruan, Chirikjian: Robust and Accurate Superquadric Recovery, CVPR 2022.

    Parameters
    ----------
    points : (N, 3) array
        In metres; finite, and not all on one plane.
    parameters : EmsParameters
    viewpoint : (3,) array
        Where the sensor was, in metres: a sheet of points is taken for the near face.
    fit_points : int
        The loop runs on at most so many points, drawn without replacement; the
        probabilities that are returned are of all.
    rng : np.random.Generator
    """
    frame = FitFrame.of(points)
    cloud = frame.to_fit(points)
    sample = cloud
    if len(cloud) > fit_points:
        sample = cloud[np.sort(rng.choice(len(cloud), fit_points, replace=False))]
    extents = np.ptp(cloud, axis=0)
    volume = float(np.prod(np.maximum(extents, THINNEST * np.sort(extents)[1])))
    start = first_guess(sample, (frame.centre - viewpoint) @ frame.axes)
    state, variance = _iterate(sample, start, volume, parameters)
    distances = state.distances(cloud)
    probability = inlier_probability(distances, variance, parameters.outlier_ratio, volume)
    if (probability >= OUTLIER_PROBABILITY).sum() < UNKNOWNS:
        # It stands on nothing: too few or too scattered points for outliers to be told.
        trusting = parameters.model_copy(update={"outlier_ratio": 0.0})
        state, _ = _iterate(sample, start, volume, trusting)
        distances = state.distances(cloud)
        probability = np.ones(len(cloud))
    return Fit(frame.to_metres(state), probability, distances * frame.unit)


def _iterate(
    points: Array, state: State, volume: float, parameters: EmsParameters
) -> tuple[State, float]:
    variance, cost, switches = START_VARIANCE, np.inf, 0
    for iteration in range(parameters.max_iterations):
        check_deadline()
        weights = inlier_probability(
            state.distances(points), variance, parameters.outlier_ratio, volume
        )
        bounds = current_bounds(points, state, adaptive=parameters.adaptive_upper_bound)
        state, new_cost = maximize(points, weights, state, bounds)
        settled = cost - new_cost < parameters.relative_tolerance * new_cost
        variance, cost = max(new_cost / 3, _LEAST_VARIANCE), new_cost
        if cost * weights.sum() < parameters.tolerance and iteration > 0:
            break
        if not settled:
            continue
        if switches < parameters.max_switches:
            switches += 1
            bounds = current_bounds(points, state, adaptive=parameters.adaptive_upper_bound)
            better = switch(points, weights, state, cost, bounds)
            if better is not None:
                state, cost = better
                variance = max(cost / 3, _LEAST_VARIANCE)
        elif iteration + 1 >= _LEAST_ITERATIONS:
            break
    return state, variance
