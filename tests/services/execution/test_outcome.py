from __future__ import annotations

import pytest

from services.execution.outcome import Held, judged, missed, obstructed
from services.execution.placement import Obstruction

HELD = Held(left=20.0, right=19.0, opening=0.04, rise=0.3, standing=False)


def test_held_in_the_air_is_lifted() -> None:
    verdict = judged(HELD)
    assert verdict.outcome == "lifted"
    assert "300.0 mm" in verdict.message


@pytest.mark.parametrize(
    ("end", "says"),
    [
        (HELD._replace(left=0.0), "left the fingers"),
        (HELD._replace(standing=True), "still touches the table"),
        (HELD._replace(rise=0.01), "hangs too low"),
    ],
)
def test_anything_less_is_slipped(end: Held, says: str) -> None:
    verdict = judged(end)
    assert verdict.outcome == "slipped_in_lift"
    assert says in verdict.message


def test_one_finger_alone_is_a_miss() -> None:
    verdict = missed(20.0, 0.0, 0.001)
    assert verdict is not None
    assert verdict.outcome == "missed"
    assert "only the left one" in verdict.message
    assert missed(20.0, 20.0, 0.04) is None


def test_an_arm_in_the_table_counts_more_than_reach() -> None:
    noted = Obstruction(tried=48, table=("panda_link6", 0.03))
    noted.note_unreached("lift")
    verdict = obstructed(noted)
    assert verdict.outcome == "collision_with_table"
    assert "47 of 48" in verdict.message
    assert "panda_link6 would be 30.0 mm" in verdict.message


def test_what_no_placement_reaches_is_unreachable() -> None:
    noted = Obstruction(tried=2)
    noted.note_unreached("lift")
    noted.note_unreached("pregrasp")
    assert obstructed(noted).outcome == "unreachable"
    assert "1 at the lift, 1 at the pregrasp" in obstructed(noted).message


def test_an_object_in_the_way_is_unreachable() -> None:
    verdict = obstructed(Obstruction(tried=5, object=("panda_link7", 0.02)))
    assert verdict.outcome == "unreachable"
    assert "panda_link7 would be 20.0 mm inside the object" in verdict.message
