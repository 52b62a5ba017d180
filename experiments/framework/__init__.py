"""What every experiment shares: questions to a backend, scores, tables, plots and the report."""

from experiments.framework.asking import Asked, ask
from experiments.framework.cells import MeanStd, Share
from experiments.framework.experiment import Context, Experiment, Findings, Image, Plot
from experiments.framework.tables import Table
from experiments.framework.views import ShownView, ViewSet

__all__ = [
    "Asked",
    "Context",
    "Experiment",
    "Findings",
    "Image",
    "MeanStd",
    "Plot",
    "Share",
    "ShownView",
    "Table",
    "ViewSet",
    "ask",
]
