"""A.1.1 of the thesis: tuning the superquadric recovery on objects whose parts are known."""

from experiments.tuning.experiment import TRIALS, run, tuning

__all__ = ["TRIALS", "run", "tuning"]
