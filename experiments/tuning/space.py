"""What is tuned: the eight parameters of Table A.1 and their ranges."""

from __future__ import annotations

from dataclasses import dataclass

import optuna

from shared.schemas.primitive import EmsParameters


@dataclass(frozen=True)
class Tuned:
    """A parameter: a number from `low` to `high`, or yes and no where there is no range.

    Attributes
    ----------
    name : str
        In `EmsParameters`.
    thesis_name, description : str
        As Table A.1 has them.
    low, high : int or float, optional
    log : bool
        Whether its logarithm is drawn evenly: where the range spans two decades.
    """

    name: str
    thesis_name: str
    description: str
    low: float | None = None
    high: float | None = None
    log: bool = False

    @property
    def range_text(self) -> str:
        if self.low is None or self.high is None:
            return "true, false"
        return f"{self.low:g} to {self.high:g}{', logarithmic' if self.log else ''}"

    def drawn(self, trial: optuna.Trial) -> float | bool:
        """Return the value that a trial proposes."""
        if self.low is None or self.high is None:
            return bool(trial.suggest_categorical(self.name, [False, True]))
        if isinstance(self.low, int) and isinstance(self.high, int):
            return int(trial.suggest_int(self.name, self.low, self.high))
        return float(trial.suggest_float(self.name, self.low, self.high, log=self.log))


SPACE = (
    # With a prior of 1 there would be nothing but outliers; the message allows 0.9999.
    Tuned("outlier_ratio", "OutlierRatio", "prior outlier probability", 0.0, 0.9999),
    Tuned("max_iterations", "MaxIterationEM", "rounds of EM at most", 10, 30),
    Tuned("tolerance", "ToleranceEM", "absolute tolerance of EM", 1e-4, 1e-2, log=True),
    Tuned(
        "relative_tolerance", "RelativeToleranceEM", "relative tolerance of EM", 1e-2, 1.0, log=True
    ),
    Tuned("max_switches", "MaxiSwitch", "switches at most", 1, 8),
    Tuned("adaptive_upper_bound", "AdaptiveUpperBound", "restricts a primitive's volume"),
    Tuned("eps", "Eps", "reach of DBSCAN, metres", 1e-3, 1e-1, log=True),
    Tuned("min_points", "MinPoints", "points that a further primitive needs", 50, 500),
)


def drawn_parameters(trial: optuna.Trial) -> EmsParameters:
    """Return the parameters that a trial proposes."""
    return EmsParameters.model_validate({each.name: each.drawn(trial) for each in SPACE})
