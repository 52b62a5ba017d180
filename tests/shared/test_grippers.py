from __future__ import annotations

from pathlib import Path

import pytest

from shared.errors import UnknownGripper
from shared.grippers import GripperSettings, choose_gripper, load_grippers
from shared.schemas.gripper import ParallelGripper, SuctionGripper

GOOD = """name = "{name}"
description = "test"
max_opening = 0.05
finger_width = 0.02
finger_thickness = 0.01
finger_length = {length}
tip_beyond_tcp = 0.01
palm_size = [0.06, 0.1, 0.06]
"""


def test_the_shipped_grippers() -> None:
    grippers = load_grippers()
    fingers = ["onrobot_rg6", "panda", "robotiq_2f140", "robotiq_2f85", "tiago"]
    assert list(grippers) == sorted([*fingers, "onrobot_vgc10"])
    openings = {
        name: gripper.max_opening
        for name, gripper in grippers.items()
        if isinstance(gripper, ParallelGripper)
    }
    assert list(openings.values()) == [0.16, 0.08, 0.14, 0.085, 0.09]
    assert list(openings) == fingers
    cup = grippers["onrobot_vgc10"]
    assert isinstance(cup, SuctionGripper)
    assert cup.force == pytest.approx(450e-6 * 0.6 * 101325, rel=0.02)  # area x underpressure


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


SUCTION = """kind = "suction"
name = "mine"
description = "test"
cup_diameter = 0.03
cup_length = 0.05
compliance = 0.002
palm_size = [0.06, 0.06, 0.1]
force = 30
"""


def test_the_users_folder_adds_and_replaces(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "mine.toml").write_text(SUCTION)
    (tmp_path / "panda.toml").write_text(GOOD.format(name="panda", length=0.05))
    monkeypatch.setenv("SPARGE_GRIPPERS_DIR", str(tmp_path))
    grippers = load_grippers(GripperSettings().grippers_dir)
    assert isinstance(grippers["mine"], SuctionGripper)
    panda = grippers["panda"]
    assert isinstance(panda, ParallelGripper)
    assert panda.max_opening == 0.05
    assert list(grippers) == sorted(grippers)
    assert "tiago" in grippers


def test_a_folder_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no folder"):
        load_grippers(tmp_path / "none")
