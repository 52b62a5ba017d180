"""Labelled views of objects on a table: made from the catalogue or from meshes, and read back."""

from experiments.dataset.make import Summary, make_dataset, make_view
from experiments.dataset.options import DatasetOptions
from experiments.dataset.output import CLEAN, NOISY
from experiments.dataset.reader import ViewFile, read_view, read_views, view_files
from experiments.dataset.view import DEPTH_SCALE, LabelledView

__all__ = [
    "CLEAN",
    "DEPTH_SCALE",
    "NOISY",
    "DatasetOptions",
    "LabelledView",
    "Summary",
    "ViewFile",
    "make_dataset",
    "make_view",
    "read_view",
    "read_views",
    "view_files",
]
