"""Fixtures that all tests may use."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from tests.support.serving import Client, in_process


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20260101)


@pytest.fixture(scope="session")
def backend(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    """Return the embedded backend, started once for all tests that only ask it."""
    from services.wiring import create_app

    with pytest.MonkeyPatch.context() as environment:
        knowledge = str(tmp_path_factory.mktemp("knowledge"))
        environment.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", knowledge)
        environment.setenv("SPARGE_GATEWAY_QUEUE_WAIT_S", "300")  # tests want answers
        environment.setenv("SPARGE_GATEWAY_REHEARSAL_TIME_S", "300")
        with in_process(create_app()) as served:
            yield served
