from __future__ import annotations

from collections.abc import Iterator

import pytest

from services.execution.arm import Arm
from services.execution.bullet import Bullet, physics


@pytest.fixture
def bullet() -> Iterator[Bullet]:
    with physics() as world:
        yield world


@pytest.fixture
def arm(bullet: Bullet) -> Arm:
    return Arm(bullet)
