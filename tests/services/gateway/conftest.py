"""The embedded backend, started once."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from services.wiring import create_app
from tests.support.serving import Client, in_process


@pytest.fixture(scope="session")
def backend(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    with pytest.MonkeyPatch.context() as environment:
        knowledge = str(tmp_path_factory.mktemp("knowledge"))
        environment.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", knowledge)
        with in_process(create_app()) as served:
            yield served
