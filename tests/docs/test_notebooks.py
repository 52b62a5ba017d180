"""Every notebook under docs/ runs from its first cell to its last, in a kernel of its own."""

from __future__ import annotations

import importlib
import os
from pathlib import Path
from typing import Any

import pytest
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbformat import NotebookNode

from shared.settings import PROJECT_ROOT
from tests.support.relay import relay
from tests.support.serving import Client, serving

nbformat: Any = importlib.import_module("nbformat")  # has types in part only
NOTEBOOKS = sorted((PROJECT_ROOT / "docs" / "notebooks").glob("*.ipynb"))


def run(notebook: NotebookNode, url: str, folder: Path, environment: pytest.MonkeyPatch) -> None:
    """Run a notebook in place, as if opened in its folder."""
    path = f"{PROJECT_ROOT}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"
    for name, value in {
        "SPARGE_URL": url,
        "PYTHONPATH": path,
        "IPYTHONDIR": str(folder),
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    }.items():
        environment.setenv(name, value)
    where = {"metadata": {"path": str(PROJECT_ROOT / "docs" / "notebooks")}}
    NotebookClient(notebook, timeout=120, kernel_name="python3", resources=where).execute()


def printed(notebook: NotebookNode) -> str:
    """Return all text that the cells have shown."""
    outputs = [each for cell in notebook.cells for each in cell.get("outputs", ())]
    return "\n".join(
        each.get("text") or each.get("data", {}).get("text/plain", "") for each in outputs
    )


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_runs(
    path: Path, backend: Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    notebook = nbformat.read(path, as_version=4)
    with serving(relay(backend)) as url:
        run(notebook, url, tmp_path, monkeypatch)
        found = printed(notebook)
        for word in (
            "camera_from_grasp",
            "base_from_grasp",
            "wrap_grasp",
            "object_lacks",
            "lifted",
        ):
            assert word in found
        images = [o for c in notebook.cells for o in c.get("outputs", ()) if "data" in o]
        assert any("image/png" in each.data for each in images)
        broken = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("1 / 0")])
        with pytest.raises(CellExecutionError, match="ZeroDivisionError"):
            run(broken, url, tmp_path, monkeypatch)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_is_kept_without_outputs(path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    for cell in notebook.cells:
        assert not cell.get("outputs")
        assert cell.get("execution_count") is None


def test_there_is_one() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["first_grasp"]
