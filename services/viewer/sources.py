"""What can be looked at: bundled views, a file, the files of a folder, what is uploaded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from copy import copy
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shared.client.view import points_of
from shared.errors import NotFound, UnreadableFile
from shared.schemas.scene import View
from shared.wire.codec import validate
from shared.wire.files import EXTENSIONS, extension_of, read_cloud_file

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Seen:
    """A view, and the points that answers about it speak of.

    Attributes
    ----------
    view : View
        Points, or a depth image.
    points : (N, 3) array
        In metres; a depth image's row-major, zero where nothing came back.
    """

    view: View
    points: Array

    @classmethod
    def of(cls, view: View) -> Seen:
        """Return a view with its points."""
        return cls(view, points_of(view))

    @property
    def viewpoint(self) -> Array:
        """Position of the sensor, metres."""
        return np.asarray(self.view.viewpoint, dtype=np.float64)

    def arrays(self) -> dict[str, Any]:
        """Return what a request holds of it."""
        names = ("points", "depth", "intrinsics", "depth_scale")
        held = {name: getattr(self.view, name) for name in names}
        return {name: value for name, value in held.items() if value is not None}


class Sources(Mapping[str, Callable[[], Seen]]):
    """Views by name, read when they are asked for.

    Files of one name in several places are told apart by their paths.

    Parameters
    ----------
    places : iterable of Path
        Files, and folders whose files are taken; what cannot be read by its suffix is left out.
    **camera
        `intrinsics`, `depth_scale` and `viewpoint` for the files that lack them.

    Raises
    ------
    NotFound
        There is nothing in them that can be read.
    """

    def __init__(self, *places: Path, **camera: Any) -> None:
        self._viewpoint = camera.pop("viewpoint", None)
        self._camera = camera
        self._read: dict[str, Callable[[], Seen]] = {}
        files = dict.fromkeys(file for place in places for file in _clouds(place))
        names = Counter(file.name for file in files)
        for file in files:
            name = file.name if names[file.name] == 1 else str(file)
            self._read[name] = partial(self._read_file, file)
        if not self._read:
            listed = ", ".join(map(str, places))
            raise NotFound(
                f"nothing to look at in {listed}; files end in {', '.join(sorted(EXTENSIONS))}"
            )

    def read(self, name: str, data: bytes) -> Seen:
        """Return the view in the bytes of a file.

        Raises
        ------
        UnreadableFile, InvalidInput
            They are no view.
        """
        held = read_cloud_file(name, data, **self._camera).fields()
        if self._viewpoint is not None:
            held["viewpoint"] = self._viewpoint
        return Seen.of(validate(View, held))

    def _read_file(self, file: Path) -> Seen:
        try:
            data = file.read_bytes()
        except OSError as error:
            raise UnreadableFile(f"{file}: {error.strerror}", found=str(file)) from None
        return self.read(file.name, data)

    def copy(self) -> Sources:
        """Return the same views, to which others may be added."""
        other = copy(self)
        other._read = dict(self._read)
        return other

    def take_in(self, name: str, data: bytes) -> str:
        """Add the view in the bytes of a file; return the name that it has here.

        Raises
        ------
        UnreadableFile, InvalidInput
            They are no view.
        """
        seen = self.read(name, data)
        number, free = 1, name
        while free in self._read:
            number += 1
            free = f"{name} ({number})"
        self._read[free] = lambda: seen
        return free

    def __getitem__(self, name: str) -> Callable[[], Seen]:
        return self._read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._read)

    def __len__(self) -> int:
        return len(self._read)


def _clouds(place: Path) -> list[Path]:
    """Return a file, or those of a folder worth a try; labels beside a view are no view."""
    if not place.is_dir():
        return [place]
    return [
        file
        for file in sorted(place.iterdir())
        if file.is_file() and extension_of(file.name) in EXTENSIONS and ".labels." not in file.name
    ]
