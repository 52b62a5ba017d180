"""The experiments, by name; one is imported when it is asked for."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from experiments.framework import Experiment
from shared.errors import InvalidInput

EXPERIMENTS: Mapping[str, str] = MappingProxyType(
    {
        "regions": "experiments.regions.experiment:REGIONS",
        "primitives": "experiments.primitives.experiment:PRIMITIVES",
        "grasps": "experiments.grasps.experiment:GRASPS",
        "timing": "experiments.timing.experiment:TIMING",
        "extension": "experiments.extension.experiment:EXTENSION",
        "demo": "experiments.demo.experiment:DEMO",
        "tuning": "experiments.tuning.experiment:tuning",
        "shapes": "experiments.shapes.experiment:shapes",
        "robustness": "experiments.robustness.experiment:ROBUSTNESS",
    }
)
"""Name -> module:object, in the order of the report."""
TAKES: Mapping[str, str] = MappingProxyType({"human_labels": "shapes", "trials": "tuning"})
"""Which experiment an option is for; it is made by a function of this option alone."""


def experiment(
    name: str, *, human_labels: Path | None = None, trials: int | None = None
) -> Experiment:
    """Return an experiment.

    Parameters
    ----------
    name : str
    human_labels : Path, optional
        A file of shapes that people named, for `shapes`.
    trials : int, optional
        How many sets of parameters are tried, for `tuning`.

    Raises
    ------
    InvalidInput
        There is none of this name, or it does not take what is given.
    """
    if name not in EXPERIMENTS:
        raise InvalidInput(
            f"there is no experiment {name!r}; there are {', '.join(EXPERIMENTS)}",
            field="name",
            found=name,
            allowed=list(EXPERIMENTS),
        )
    given = {"human_labels": human_labels, "trials": trials}
    options = {option: value for option, value in given.items() if value is not None}
    for option in options:
        if TAKES[option] != name:
            words = option.replace("_", " ")
            raise InvalidInput(f"only {TAKES[option]} takes {words}, not {name}", field=option)
    module, _, attribute = EXPERIMENTS[name].partition(":")
    found = getattr(importlib.import_module(module), attribute)
    made = found(*options.values()) if name in TAKES.values() else found
    assert isinstance(made, Experiment)
    return made
