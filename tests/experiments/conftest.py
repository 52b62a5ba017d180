"""What all experiments are tested with: the backend's public client, and a few views."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from rich.console import Console

from experiments.dataset import DatasetOptions, make_dataset
from experiments.framework import Context, ViewSet
from experiments.framework.views import scan_sets
from shared.client import Sparge
from tests.support.serving import Client

SHOWN = ("bottle1", "can1", "hammer1", "knife1")

MakeContext = Callable[..., Context]


@pytest.fixture(scope="session")
def sparge(backend: Client) -> Sparge:
    return Sparge(backend.request)


@pytest.fixture(scope="session")
def views_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("dataset")
    make_dataset(folder, DatasetOptions(views=1, objects=SHOWN))
    return folder / "views_clean"


@pytest.fixture(scope="session")
def few_things(views_folder: Path) -> ViewSet:
    (views,) = scan_sets([views_folder])
    return views


@pytest.fixture
def make_context(sparge: Sparge, few_things: ViewSet, tmp_path: Path) -> MakeContext:
    """Return what makes a context about the named objects."""

    def make(*names: str) -> Context:
        chosen = few_things.only(lambda file: file.object_name in names)
        return Context(sparge, Console(quiet=True), tmp_path, (chosen,), workers=2)

    return make
