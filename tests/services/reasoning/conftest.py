"""A warm reasoner with an empty knowledge folder."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings


@pytest.fixture
def settings(tmp_path: Path) -> ReasoningSettings:
    return ReasoningSettings(knowledge_dir=tmp_path / "knowledge")


@pytest.fixture
def reasoner(settings: ReasoningSettings) -> Iterator[Reasoner]:
    stage = Reasoner(settings)
    stage.warm_up()
    yield stage
    stage.close()
