"""Reads gripper files and finds a gripper by name."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path

from pydantic import Field, TypeAdapter, ValidationError

from shared.errors import UnknownGripper
from shared.schemas.gripper import Gripper, ParallelGripper, SuctionGripper
from shared.settings import ServiceSettings

SHIPPED = Path(__file__).resolve().parent
_GRIPPER: TypeAdapter[ParallelGripper | SuctionGripper] = TypeAdapter(Gripper)


class GripperSettings(ServiceSettings):
    """What a service that knows grippers can be told.

    Attributes
    ----------
    grippers_dir : Path or None
        Folder of the user's own gripper files, from `SPARGE_GRIPPERS_DIR`; every
        service that knows grippers reads the same variable.
    """

    grippers_dir: Path | None = Field(default=None, validation_alias="SPARGE_GRIPPERS_DIR")


def load_grippers(own: Path | None = None) -> dict[str, ParallelGripper | SuctionGripper]:
    """Return the shipped grippers and those of a folder by name, in alphabetical order.

    A gripper of the user's replaces a shipped one of the same name.

    Raises
    ------
    ValueError
        The folder is not there, or a file is no TOML, its name is not the gripper's,
        or its values do not make a gripper; says which file.
    """
    if own is not None and not own.is_dir():
        raise ValueError(f"SPARGE_GRIPPERS_DIR names {str(own)!r}, which is no folder")
    folders = [SHIPPED] if own is None else [SHIPPED, own]
    found = {path.stem: _read(path) for folder in folders for path in sorted(folder.glob("*.toml"))}
    return dict(sorted(found.items()))


def _read(path: Path) -> ParallelGripper | SuctionGripper:
    try:
        # kind may be left out: a parallel gripper is what people mean
        values = {"kind": "parallel", **tomllib.loads(path.read_text(encoding="utf-8"))}
        gripper = _GRIPPER.validate_python(values)
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, ValidationError) as error:
        raise ValueError(f"{path}: {error}") from error
    if gripper.name != path.stem:
        raise ValueError(f"{path} describes the gripper {gripper.name!r}")
    if min(gripper.palm_size) <= 0:
        raise ValueError(f"{path}: palm_size must be positive")
    if isinstance(gripper, ParallelGripper) and gripper.tip_beyond_tcp >= gripper.finger_length:
        raise ValueError(f"{path}: the palm must lie behind the tool centre point")
    return gripper


def choose_gripper(
    grippers: Mapping[str, ParallelGripper | SuctionGripper], name: str
) -> ParallelGripper | SuctionGripper:
    """Return the gripper of that name.

    Raises
    ------
    UnknownGripper
        Lists the known ones.
    """
    if name not in grippers:
        raise UnknownGripper(
            f"unknown gripper {name!r}; known are {', '.join(grippers)}",
            field="gripper",
            found=name,
            allowed=list(grippers),
        )
    return grippers[name]
