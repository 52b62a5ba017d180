"""What an answer can be saved as."""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import typer

from services.cli.ask import Answered

FILM, PAGE, PICTURE = ".gif", ".html", ".png"
KINDS = {
    PICTURE: "a picture of parts and grasps",
    PAGE: "a page to turn them around in, in any browser, offline",
    FILM: "a film of the best grasp that the robot finds a way to",
}
HELP = (
    "Save the answer as .png (picture), .html (3D page that works offline) or .gif (film of the "
    "execution); may be repeated"
)


@dataclass(frozen=True)
class Saved:
    """A file to be written, whose kind is known."""

    path: Path

    @property
    def kind(self) -> str:
        return self.path.suffix.lower()

    def write(self, answered: Answered) -> str:
        """Write it; return why that is not possible, or nothing."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        match self.kind:
            case ".gif":
                film = answered.film
                if film is None:
                    return answered.why_no_film
                self.path.write_bytes(film)
            case ".html":
                from services.cli.saving.page import write_page

                write_page(self.path, answered)
            case _:
                from services.cli.saving.png import write_picture

                write_picture(self.path, answered)
        return ""


def saved(paths: Sequence[Path]) -> tuple[Saved, ...]:
    """Return the files to write, once it is known that they can be.

    Raises
    ------
    typer.BadParameter
        A suffix that is no kind, a folder, the same file twice, or a package that is missing.
    """
    for path in paths:
        if path.suffix.lower() not in KINDS:
            choices = ", ".join(f"{suffix} ({what})" for suffix, what in KINDS.items())
            found = path.suffix or "no suffix"
            raise typer.BadParameter(f"--save {path}: {found} is none of {choices}")
        if path.is_dir():
            raise typer.BadParameter(f"--save {path}: that is a folder")
    if len({path.resolve() for path in paths}) < len(paths):
        raise typer.BadParameter("--save: the same file is named twice")
    files = tuple(Saved(path) for path in paths)
    if any(each.kind == PAGE for each in files) and importlib.util.find_spec("viser") is None:
        raise typer.BadParameter("--save .html needs viser; run: pip install 'sparge[view]'")
    return files


def wants_film(files: Sequence[Saved]) -> bool:
    """Return whether a grasp has to be executed for one of them."""
    return any(each.kind == FILM for each in files)
