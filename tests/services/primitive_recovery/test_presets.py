from __future__ import annotations

import dataclasses
from typing import get_args

from services.primitive_recovery.ems.presets import PRESETS
from shared.schemas.primitive import Preset

TABLE_A1 = {
    "simulation": (0.965, 18, 0.00468, 0.867, 2, False, 0.0131, 100),
    "real_world": (0.996, 18, 0.00430, 0.804, 2, True, 0.0397, 150),
}


def test_they_are_table_a1() -> None:
    assert {name: dataclasses.astuple(one)[:8] for name, one in PRESETS.items()} == TABLE_A1


def test_every_preset_of_the_message_exists() -> None:
    assert set(PRESETS) == set(get_args(Preset))
