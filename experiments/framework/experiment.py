"""An experiment: what it is given, what it finds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

from matplotlib.figure import Figure
from rich.console import Console

from experiments.framework.tables import Table
from experiments.framework.views import ViewSet
from shared.client import Sparge


@dataclass(frozen=True)
class Context:
    """What an experiment is given.

    Attributes
    ----------
    sparge : Sparge
        The backend, by its public contract.
    console : Console
        For progress.
    folder : Path
        Where the experiment may keep files of its own.
    sets : tuple of ViewSet
        The views to ask about: the catalogue's, and folders of scans.
    limit : int or None
        At most so many views of each object; None: what the experiment deems enough.
    seed : int
        Of everything random.
    workers : int
        Questions that are under way at a time, except where time is measured.
    """

    sparge: Sparge
    console: Console
    folder: Path
    sets: tuple[ViewSet, ...] = ()
    limit: int | None = None
    seed: int = 0
    workers: int = 1

    def views(self, per_object: int | None = None) -> tuple[ViewSet, ...]:
        """Return the sets, of each object at most `limit` views, or else `per_object`."""
        return tuple(each.limited(self.limit or per_object) for each in self.sets)

    def catalogue(self, per_object: int | None = None) -> ViewSet:
        """Return the catalogue's views, or the first set where there is no catalogue."""
        sets = self.views(per_object)
        return next((each for each in sets if each.is_catalogue), sets[0])


@dataclass(frozen=True)
class Plot:
    """A plot, and what it shows; `name` is that of its PNG file."""

    name: str
    caption: str
    figure: Figure


@dataclass(frozen=True)
class Image:
    """A finished picture, and what it shows.

    Attributes
    ----------
    name : str
        Of its file.
    caption : str
    data : bytes
        The file.
    kind : str
        png or gif.
    """

    name: str
    caption: str
    data: bytes
    kind: str = "png"


@dataclass(frozen=True)
class Findings:
    """What came out.

    Attributes
    ----------
    meaning : str
        Two sentences for a newcomer.
    tables : tuple of Table
        The first one is the headline.
    plots : tuple of Plot
    images : tuple of Image
        Further pictures, after the plots.
    records : sequence of mapping
        One per request, for `requests.csv`.
    """

    meaning: str
    tables: tuple[Table, ...]
    plots: tuple[Plot, ...] = ()
    records: Sequence[Mapping[str, str]] = field(default=(), repr=False)
    images: tuple[Image, ...] = ()


@dataclass(frozen=True)
class Experiment:
    """What can be run by name.

    Attributes
    ----------
    name : str
    title : str
    question : str
        What it answers, in a sentence or two.
    run : callable
    thesis : str
        Where the thesis has it.
    views_per_object : int or None
        How many views of each object of the catalogue it needs; None: no views.
    noisy_views : int
        So many of them also with the noise of a stereo camera.
    variants : int
        Random objects of every class that it needs views of as well.
    scan_views : int or None
        How many views of each object of a folder of scans; None: as many as of the catalogue's.
    """

    name: str
    title: str
    question: str
    run: Callable[[Context], Findings]
    thesis: str = ""
    views_per_object: int | None = 10
    noisy_views: int = 0
    variants: int = 0
    scan_views: int | None = None

    def asked_views(self, of_catalogue: bool) -> int | None:
        """Return how many views of each object are asked about; None: all there are."""
        return self.views_per_object if of_catalogue else self.scan_views or self.views_per_object


GLOSSARY: Mapping[str, str] = MappingProxyType(
    {
        "view": "one depth image of one object on a table",
        "task": "what the object is for; every task has a part of the object to hold it by",
        "region": "the points of the part to hold, as the backend predicts them",
        "found": "the backend named a part to hold; the thesis calls this True/False",
        "accuracy": "share of the object's points on which prediction and label agree",
        "precision": (
            "TP / (TP + FP): share of the predicted region that is right. The thesis's code "
            "computes this under the name TPR, so it stands beside the thesis's TPR here"
        ),
        "recall": "TP / (TP + FN), the true positive rate: share of the right region that is found",
        "IoU": "TP / (TP + FP + FN): intersection over union of both regions",
        "good": "IoU of at least 0.7; counted over all views, found or not",
        "refused": "nothing is found for a task that the object does not afford, as it should be",
        "grasp in region": (
            "the object point nearest to the best grasp lies in the labelled region; "
            "counted over all views"
        ),
        "±": "standard deviation over the views where a region was found (n - 1)",
        "40 %, 25–58": "a share and its 95 % Wilson score interval, in percent",
        "v1, v2": (
            "Version 1 and Version 2 of the reasoning: a rule per task; part affordances and an "
            "ontology"
        ),
    }
)
"""The words of the tables."""
