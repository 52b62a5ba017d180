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
        "grasps": "experiments.grasps.experiment:GRASPS",
        "timing": "experiments.timing.experiment:TIMING",
        "extension": "experiments.extension.experiment:EXTENSION",
        "demo": "experiments.demo.experiment:DEMO",
        "tuning": "experiments.tuning.experiment:TUNING",
        "shapes": "experiments.shapes.experiment:shapes",
        "robustness": "experiments.robustness.experiment:ROBUSTNESS",
    }
)
"""Name -> module:object, in the order of the report."""
TAKES_HUMAN_LABELS = "shapes"


def experiment(name: str, human_labels: Path | None = None) -> Experiment:
    """Return an experiment.

    Parameters
    ----------
    name : str
    human_labels : Path, optional
        A file of shapes that people named, for the experiment that takes one.

    Raises
    ------
    InvalidInput
        There is none of this name, or it takes no such file.
    """
    if name not in EXPERIMENTS:
        raise InvalidInput(
            f"there is no experiment {name!r}; there are {', '.join(EXPERIMENTS)}",
            field="name",
            found=name,
            allowed=list(EXPERIMENTS),
        )
    if human_labels is not None and name != TAKES_HUMAN_LABELS:
        raise InvalidInput(f"only {TAKES_HUMAN_LABELS} takes human labels, not {name}")
    module, _, attribute = EXPERIMENTS[name].partition(":")
    found = getattr(importlib.import_module(module), attribute)
    made = found(human_labels) if name == TAKES_HUMAN_LABELS else found
    assert isinstance(made, Experiment)
    return made
