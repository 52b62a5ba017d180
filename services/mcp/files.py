"""Which files an agent may have read: views below one folder, and the bundled samples."""

from __future__ import annotations

import os
import stat
from dataclasses import dataclass
from pathlib import Path

from shared.errors import Forbidden, InvalidInput, NotFound, PayloadTooLarge, UnsupportedMediaType
from shared.settings import PROJECT_ROOT
from shared.wire.files import EXTENSIONS, extension_of

SAMPLE = "sample:"
SAMPLES = PROJECT_ROOT / "experiments" / "samples"
MAX_BYTES = 32 * 2**20
"""What a gateway takes unless told otherwise."""


@dataclass(frozen=True)
class Root:
    """The folder that files are read from.

    Parameters
    ----------
    folder : Path
        Links below it are followed only where they stay below it.
    """

    folder: Path

    def read(self, name: str) -> tuple[str, bytes]:
        """Return the name and the bytes of a view: `sample:NAME`, or a path in the folder.

        Raises
        ------
        UnsupportedMediaType
            The name's extension is none of a view.
        Forbidden
            The path leads out of the folder.
        NotFound
            There is no such file there.
        InvalidInput
            It is something else than a file, or cannot be read.
        PayloadTooLarge
            It is larger than `MAX_BYTES`.
        """
        if name.startswith(SAMPLE):
            return self._read(SAMPLES, f"{name.removeprefix(SAMPLE)}.npz", name, samples())
        if extension_of(name) not in EXTENSIONS:
            raise UnsupportedMediaType(
                f"{name!r} is no view; files that are read are {', '.join(EXTENSIONS)}",
                found=extension_of(name),
                allowed=list(EXTENSIONS),
            )
        return self._read(self.folder, name, name, None)

    def _read(
        self, folder: Path, relative: str, asked: str, known: list[str] | None
    ) -> tuple[str, bytes]:
        place = folder.resolve()
        try:
            path = (place / relative).resolve()
        except (OSError, ValueError, RuntimeError):  # a zero byte, a circle of links
            raise InvalidInput(f"{asked!r} is no path", field="file") from None
        if not path.is_relative_to(place):
            raise Forbidden(
                f"{asked!r} is outside of the folder that this server may read; "
                "say its path relative to that folder",
                field="file",
            )
        try:
            return path.name, _contents(path)
        except FileNotFoundError:
            there = "" if known is None else f"; there are {', '.join(known)}"
            raise NotFound(f"there is no file {asked!r}{there}", field="file") from None
        except OSError as error:
            raise InvalidInput(
                f"{asked!r} cannot be read: {error.strerror}", field="file"
            ) from None


def samples() -> list[str]:
    """Return the bundled views, as `sample:bottle`."""
    names = sorted(path.stem for path in SAMPLES.glob("*.npz") if "." not in path.stem)
    return [f"{SAMPLE}{name}" for name in names]


def _contents(path: Path) -> bytes:
    # Opened once, and looked at through the handle: it cannot be exchanged in between. Without
    # O_NONBLOCK a pipe would be waited for.
    with os.fdopen(os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK), "rb") as stream:
        status = os.fstat(stream.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise InvalidInput(f"{path.name!r} is not a file", field="file")
        content = stream.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise PayloadTooLarge(
            f"{path.name!r} is larger than the {MAX_BYTES} bytes that are read", allowed=MAX_BYTES
        )
    return content
