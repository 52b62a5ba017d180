"""What the tests of the manifests look at: the base as it is, and every overlay as rendered."""

from __future__ import annotations

import pytest

from tests.kubernetes.manifests import (
    OVERLAYS,
    Object,
    base_objects,
    documents,
    rendered,
    renderer,
)

NO_RENDERER = (
    "NOT RENDERED: there is no kubectl or kustomize with kustomize 5 or later here, "
    "so only the files themselves are checked"
)


@pytest.fixture(scope="session", params=["base", *OVERLAYS])
def objects(request: pytest.FixtureRequest) -> list[Object]:
    """All objects of the base, read from its files, or of an overlay, rendered."""
    if request.param == "base":
        return base_objects()
    if renderer() is None:
        pytest.skip(NO_RENDERER)
    return documents(rendered(request.param))


@pytest.fixture(scope="session", params=OVERLAYS)
def overlay(request: pytest.FixtureRequest) -> dict[str, list[Object]]:
    """One overlay, rendered, under its name."""
    if renderer() is None:
        pytest.skip(NO_RENDERER)
    return {request.param: documents(rendered(request.param))}
