from __future__ import annotations

from typing import get_args

from shared.schemas.primitive import PRESETS, Preset

TABLE_A1 = {
    "simulation": (0.965, 18, 0.00468, 0.867, 2, False, 0.0131, 100),
    "real_world": (0.996, 18, 0.00430, 0.804, 2, True, 0.0397, 150),
}


def test_they_are_table_a1() -> None:
    assert {name: tuple(one.model_dump().values()) for name, one in PRESETS.items()} == TABLE_A1


def test_every_preset_of_the_message_exists() -> None:
    assert set(PRESETS) == set(get_args(Preset))
