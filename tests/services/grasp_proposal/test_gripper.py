from __future__ import annotations

from pathlib import Path

import pytest

from services.grasp_proposal.gripper import choose_gripper, load_grippers
from shared.errors import UnknownGripper

GOOD = """name = "{name}"
description = "test"
max_opening = 0.05
finger_width = 0.02
finger_thickness = 0.01
finger_length = {length}
tip_beyond_tcp = 0.01
palm_size = [0.06, 0.1, 0.06]
"""


def test_the_four_grippers() -> None:
    grippers = load_grippers()
    assert list(grippers) == ["panda", "robotiq_2f140", "robotiq_2f85", "tiago"]
    openings = {name: gripper.max_opening for name, gripper in grippers.items()}
    assert openings == {"panda": 0.08, "robotiq_2f140": 0.14, "robotiq_2f85": 0.085, "tiago": 0.09}


def test_an_unknown_gripper_lists_the_known() -> None:
    grippers = load_grippers()
    assert choose_gripper(grippers, "tiago").name == "tiago"
    with pytest.raises(UnknownGripper, match=r"'claw'.*panda, robotiq_2f140") as caught:
        choose_gripper(grippers, "claw")
    assert caught.value.details["allowed"] == list(grippers)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (GOOD.format(name="other", length=0.05), "describes the gripper 'other'"),
        (GOOD.format(name="mine", length=0.01), "behind the tool centre point"),
        (GOOD.format(name="mine", length=-1), "finger_length"),
        (GOOD.format(name="mine", length=0.05) + "colour = 1", "colour"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "mine.toml").write_text(text)
    with pytest.raises(ValueError, match=said):
        load_grippers(tmp_path)
