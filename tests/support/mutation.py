"""Sound things with something wrong in them: JSON documents and the bytes of files."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

Json = Any

HOSTILE: tuple[Json, ...] = (
    *(None, True, False, "", "x", "\x00", "../../etc/passwd", "{}", "a" * 10_000),
    *(-1, 0, 1, 2**31, 2**63 - 1, -(2**63), 2**64 - 1),
    *(0.0, -0.5, 1e-320, 1e-12, 1e3, 1e9, 1e308, -1e308),
    *([], {}, [[]], [None], [0], [[0, 0, 0]], [[1e9, 1e9, 1e9]] * 3),
)
FACTORS = (-1.0, 0.0, 1e-9, 1e-3, 1e3, 1e9)
CHANCE_OF_GOING_DEEPER = 0.85


def mutated(document: Json, rng: np.random.Generator) -> Json:
    """Return a copy of a JSON document that differs in one to three places."""
    changed = copy.deepcopy(document)
    for _ in range(rng.integers(1, 4)):
        changed = _changed_once(changed, rng)
    return changed


def _changed_once(value: Json, rng: np.random.Generator) -> Json:
    if isinstance(value, dict | list) and value and rng.random() < CHANCE_OF_GOING_DEEPER:
        places: list[Any] = list(value) if isinstance(value, dict) else list(range(len(value)))
        place = places[rng.integers(len(places))]
        value[place] = _changed_once(value[place], rng)
        return value
    if isinstance(value, list) and value and rng.random() < 0.7:
        return _rearranged(value, rng)
    if isinstance(value, dict) and value and rng.random() < 0.7:
        gone = list(value)[rng.integers(len(value))]
        return {name: each for name, each in value.items() if name != gone}
    if isinstance(value, int | float) and not isinstance(value, bool) and rng.random() < 0.4:
        return value * FACTORS[rng.integers(len(FACTORS))]
    return copy.deepcopy(HOSTILE[rng.integers(len(HOSTILE))])


def _rearranged(values: list[Json], rng: np.random.Generator) -> list[Json]:
    cut = int(rng.integers(len(values)))
    kinds = (values[:cut], values[cut:], values + values, [values[cut]] * len(values), values[::-1])
    return copy.deepcopy(kinds[rng.integers(len(kinds))])


def mutated_bytes(data: bytes, rng: np.random.Generator) -> bytes:
    """Return the bytes of a file with some flipped, replaced, inserted, taken out or cut off."""
    changed = bytearray(data)
    for _ in range(rng.integers(1, 6)):
        if not changed:
            break
        place = int(rng.integers(len(changed)))
        length = min(int(rng.integers(1, 9)), len(changed) - place)
        match rng.integers(6):
            case 0:
                changed[place] ^= 1 << int(rng.integers(8))
            case 1:
                changed[place : place + length] = rng.bytes(length)
            case 2:
                changed[place : place + length] = bytes([int(rng.choice((0, 255)))]) * length
            case 3:
                changed[place:place] = rng.bytes(length)
            case 4:
                del changed[place : place + length]
            case _:
                other = int(rng.integers(len(changed)))
                changed[place : place + length] = changed[other : other + length]
    if rng.random() < 0.2:
        del changed[int(rng.integers(len(changed) + 1)) :]
    return bytes(changed)
