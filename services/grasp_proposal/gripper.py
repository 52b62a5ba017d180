"""The grippers that are known: one TOML file each."""

from __future__ import annotations

import tomllib
from pathlib import Path

from shared.errors import UnknownGripper
from shared.schemas.grasp import Gripper

GRIPPER_FOLDER = Path(__file__).resolve().parent / "grippers"


def load_grippers(folder: Path = GRIPPER_FOLDER) -> dict[str, Gripper]:
    """Return the grippers of all TOML files in `folder` by name, in alphabetical order.

    Raises
    ------
    ValueError
        A file whose name is not the gripper's, or whose values do not make a gripper.
    """
    grippers = {}
    for path in sorted(folder.glob("*.toml")):
        gripper = Gripper.model_validate(tomllib.loads(path.read_text(encoding="utf-8")))
        if gripper.name != path.stem:
            raise ValueError(f"{path.name} describes the gripper {gripper.name!r}")
        if gripper.tip_beyond_tcp >= gripper.finger_length or min(gripper.palm_size) <= 0:
            raise ValueError(f"{path.name}: the palm must lie behind the tool centre point")
        grippers[gripper.name] = gripper
    return grippers


def choose_gripper(grippers: dict[str, Gripper], name: str) -> Gripper:
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
