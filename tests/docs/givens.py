"""What pages take for granted: a folder of clouds, a mesh of one's own."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.catalogue import CatalogueObject, build
from shared.geometry.points import points_from_depth
from tests.support.samples import sample_path


def of_annotate(folder: Path) -> None:
    """Lay a folder of clouds, and the labels that a run over it has written."""
    from services.annotate.label import label
    from services.annotate.parts import PartedTable
    from services.annotate.question import Job, Question, Refusal, Terms
    from services.annotate.schema import ANNOTATIONS
    from tests.support.annotating import LightPipeline

    (folder / "clouds").mkdir()
    shutil.copy(sample_path("bottle"), folder / "clouds" / "bottle.npz")
    question = Question(("pouring",), {"seed": 0})
    job = Job("bottle.npz", "pouring", "0" * 64, b"cloud")
    row = label(LightPipeline(), job, question.parameters, Terms(question.settings, "digest"))
    assert not isinstance(row, Refusal)
    table = PartedTable(folder / "labels" / "annotations", ANNOTATIONS)
    table.add(row)
    table.flush()


def of_catalogue(folder: Path) -> None:
    """Lay the mesh of one's own beside the label file that the page shows."""
    _write_mesh(build("pan"), folder / "my_meshes" / "saucepan.obj", metres_per_unit=1e-3)


def of_dataset(folder: Path) -> None:
    """Lay a label file with its mesh."""
    _write_mesh(build("hammer"), folder / "scans" / "hammer.obj", metres_per_unit=1.0)
    label = {"file": "hammer.obj", "regions": {"hammering": ["x", ">", 0]}}
    (folder / "scans" / "objects.json").write_text(json.dumps({"objects": {"my_hammer": label}}))


class Robot:
    """A stand-in for the driver of an arm, which every reader has another of."""

    def move_to(self, base_from_grasp: NDArray[np.float64]) -> None:
        """Take a pose (4, 4) and go nowhere."""
        assert base_from_grasp.shape == (4, 4)
        assert np.isfinite(base_from_grasp).all()


def of_client() -> dict[str, Any]:
    """Return the reader's own things: a cloud, a calibrated camera, an arm."""
    with np.load(sample_path("bottle")) as view:
        points = points_from_depth(view["depth"], view["intrinsics"], float(view["depth_scale"]))
    return {
        "points": points,
        "bottle_points": points,
        "mug_points": points,
        "calibration": np.eye(4),
        "robot": Robot(),
    }


NAMES: Mapping[str, Callable[[], dict[str, Any]]] = {
    "client.md": of_client,
    "README.md": of_client,
}
"""By page: what its snippets call by a name without making it."""

FOR: Mapping[str, Callable[[Path], None]] = {
    "annotate.md": of_annotate,
    "catalogue.md": of_catalogue,
    "dataset.md": of_dataset,
}


def _write_mesh(thing: CatalogueObject, path: Path, metres_per_unit: float) -> None:
    path.parent.mkdir(parents=True)
    rows = [f"v {x} {y} {z}" for x, y, z in thing.surface.vertices / metres_per_unit]
    rows += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in thing.surface.faces]
    path.write_text("\n".join(rows) + "\n")
