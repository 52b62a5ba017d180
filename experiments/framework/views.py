"""Labelled views: what an experiment asks about, and the truth that it compares with."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from experiments.catalogue import CatalogueObject
from experiments.dataset import (
    DEPTH_SCALE,
    LabelledView,
    ViewFile,
    read_view,
    view_files,
)
from experiments.dataset.manifest import read_manifest
from shared.errors import InvalidInput
from shared.geometry.points import points_from_depth

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

NOT_AFFORDED: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "cooking": ("hammering", "cutting"),
        "hammering": ("cooking", "pouring", "scooping", "turning", "cutting"),
        "pouring": ("cooking", "hammering", "scooping", "turning", "cutting"),
        "scooping": ("cooking", "hammering", "pouring", "cutting"),
        "turning": ("cooking", "hammering", "pouring", "cutting"),
        "cutting": ("cooking", "hammering", "pouring", "scooping"),
    }
)
"""What a thing made for the key's task clearly does not afford; doubtful pairs are left out."""


@dataclass(frozen=True)
class ShownView:
    """A labelled view in the form in which a backend is asked about it.

    Attributes
    ----------
    view : LabelledView
    depth_scale : float
        Metres per unit of depth.
    """

    view: LabelledView
    depth_scale: float = DEPTH_SCALE

    @property
    def tasks(self) -> tuple[str, ...]:
        return self.view.tasks

    @cached_property
    def on_object(self) -> Mask:
        """Which of the view's H*W points are the object's."""
        return self.view.on_object.ravel()

    @cached_property
    def points(self) -> Array:
        """All H*W points in metres in the camera's frame; NaN is no return."""
        return points_from_depth(self.view.depth, self.view.intrinsics, self.depth_scale)

    @property
    def object_points(self) -> Array:
        """The object's points (N, 3)."""
        return np.asarray(self.points[self.on_object])

    def truth(self, task: str) -> Mask:
        """Return which of the object's points (N,) are in the region of `task`."""
        return np.asarray(self.view.region(task).ravel()[self.on_object])

    def arrays(self) -> dict[str, ArrayLike]:
        """Return the view as POST /grasp takes it."""
        return {
            "depth": self.view.depth,
            "intrinsics": self.view.intrinsics,
            "depth_scale": np.float64(self.depth_scale),
        }

    def without(self, lost: Mask) -> ShownView:
        """Return the view where the pixels `lost` (H, W) give no return, and have no label."""
        view = replace(
            self.view,
            depth=np.where(lost, np.uint16(0), self.view.depth),
            label=np.where(lost, np.uint8(0), self.view.label),
            regions=self.view.regions & ~lost,
        )
        return replace(self, view=view)


@dataclass(frozen=True)
class Thing:
    """What is known about an object.

    Attributes
    ----------
    class_name : str
        What kind of thing it is; empty if unknown.
    not_afforded : tuple of str, optional
        Tasks for which the right answer is that nothing is found. Without it,
        what `NOT_AFFORDED` says about the object's tasks.
    """

    class_name: str = ""
    not_afforded: tuple[str, ...] | None = None

    def refused_tasks(self, tasks: Sequence[str]) -> tuple[str, ...]:
        """Return the tasks that an object made for `tasks` does not afford."""
        if self.not_afforded is not None:
            return self.not_afforded
        return tuple(other for task in tasks for other in NOT_AFFORDED.get(task, ()))


@dataclass(frozen=True)
class ViewSet:
    """Views of one origin.

    Attributes
    ----------
    name : str
        As it is called in tables.
    files : tuple of ViewFile
    things : mapping
        What is known about the objects, by name.
    is_catalogue : bool
        Made by this project, as opposed to a folder of scans.
    objects : mapping
        The objects themselves, by name, where they are known.
    """

    name: str
    files: tuple[ViewFile, ...] = field(repr=False)
    things: Mapping[str, Thing] = field(default_factory=dict, repr=False)
    is_catalogue: bool = False
    objects: Mapping[str, CatalogueObject] = field(default_factory=dict, repr=False)

    def thing(self, file: ViewFile) -> Thing:
        """Return what is known about the object of a view."""
        return self.things.get(file.object_name, Thing())

    def only(self, wanted: Callable[[ViewFile], bool]) -> ViewSet:
        """Return it with the wanted views."""
        return replace(self, files=tuple(filter(wanted, self.files)))

    def named(self, name: str) -> ViewSet:
        """Return it under another name."""
        return replace(self, name=name)

    def serving(self, task: str) -> ViewSet:
        """Return it with the views of objects that serve a task; opens one view of each."""
        first = {file.object_name: file for file in reversed(self.files)}
        serve = {name for name, file in first.items() if task in read_view(file.path).tasks}
        return self.only(lambda file: file.object_name in serve)

    def limited(self, per_object: int | None) -> ViewSet:
        """Return it with at most so many views of each object, the first ones."""
        if per_object is None:
            return self
        seen: dict[str, int] = {}
        kept = []
        for each in self.files:
            seen[each.object_name] = seen.get(each.object_name, 0) + 1
            if seen[each.object_name] <= per_object:
                kept.append(each)
        return replace(self, files=tuple(kept))


def load(file: ViewFile) -> ShownView:
    """Return a view from its file.

    Raises
    ------
    InvalidInput
        The file is no labelled view, or shows no object.
    """
    view = read_view(file.path)
    if not view.on_object.any():
        raise InvalidInput(f"{file.path} shows no labelled object")
    return ShownView(view)


def scan_sets(folders: Sequence[Path]) -> tuple[ViewSet, ...]:
    """Return the views of folders `<object>/<number>.npz`, under names that tell them apart.

    What a folder's dataset says about its objects is taken over.

    Raises
    ------
    InvalidInput
        A folder holds no views.
    """
    paths = [folder.resolve() for folder in folders]
    names = [path.name for path in paths]
    return tuple(
        ViewSet(
            f"{path.parent.name}/{path.name}" if names.count(path.name) > 1 else path.name,
            view_files(path),
            things_of(path.parent),
        )
        for path in paths
    )


def things_of(dataset: Path) -> dict[str, Thing]:
    """Return what a dataset's manifest says about its objects; nothing where there is none.

    Raises
    ------
    InvalidInput
        There is a manifest that cannot be read.
    """
    manifest = read_manifest(dataset) or {"objects": {}}
    return {
        name: Thing(held["class"], tuple(held["not_afforded"]) or None)
        for name, held in manifest["objects"].items()
    }
