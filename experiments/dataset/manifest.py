"""`manifest.json`: what a dataset is, and whether it is whole."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from experiments.camera import D435, StereoNoise
from experiments.catalogue import CatalogueObject
from experiments.dataset.options import DatasetOptions
from experiments.dataset.scene import HEAD_HEIGHT, TABLE_HEIGHTS
from experiments.dataset.view import DEPTH_SCALE
from shared import __version__
from shared.errors import InvalidInput

NAME = "manifest.json"
FORMAT, FORMAT_VERSION = "sparge-views", 1

Manifest = dict[str, Any]


def manifest_of(
    options: DatasetOptions, noise: StereoNoise, things: Sequence[CatalogueObject]
) -> Manifest:
    """Return the manifest of a dataset that is not complete yet."""
    return {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "sparge_version": __version__,
        "complete": False,
        "seed": options.seed,
        "options": options.as_json(),
        "depth_scale": DEPTH_SCALE,
        "camera": {
            "width": D435.width,
            "height": D435.height,
            "focal_length": D435.focal_length,
            "above_floor": HEAD_HEIGHT,
        },
        "table_heights": list(TABLE_HEIGHTS),
        "noise": {
            "sigma_at_1m": noise.sigma_at_1m,
            "step_at_1m": noise.step_at_1m,
            "edge_jump": noise.edge_jump,
            "edge_dropout": noise.edge_dropout,
            "correlation_px": noise.correlation_px,
        }
        if options.noise
        else None,
        "objects": {thing.name: _entry(thing) for thing in things},
    }


def _entry(thing: CatalogueObject) -> Manifest:
    return {
        "class": thing.class_name,
        "description": thing.description,
        "tasks": {task: list(parts) for task, parts in thing.regions.items()},
        "not_afforded": list(thing.not_afforded),
        "geometry_sha256": _digest(thing),
    }


def _digest(thing: CatalogueObject) -> str:
    """Return a digest of the shape, blind to differences under a micrometre."""
    digest = hashlib.sha256()
    for part in thing.parts:
        digest.update(f"{part.name} {part.density!r}\n".encode())
        for mesh in part.meshes:
            digest.update(np.round(mesh.vertices * 1e6).astype("<i8").tobytes())
            digest.update(mesh.faces.astype("<i4").tobytes())
    return digest.hexdigest()


def encode(manifest: Manifest) -> bytes:
    """Return the file's bytes."""
    return (json.dumps(manifest, indent=2, ensure_ascii=False) + "\n").encode()


def read_manifest(folder: Path) -> Manifest | None:
    """Return the manifest of a dataset, or None where there is none.

    Raises
    ------
    InvalidInput
        The file is not a manifest.
    """
    path = folder / NAME
    try:
        held = json.loads(path.read_bytes())
    except FileNotFoundError:
        return None
    except (OSError, ValueError, RecursionError) as error:
        raise InvalidInput(f"{path} cannot be read as a manifest: {error}") from None
    if not isinstance(held, dict) or held.get("format") != FORMAT:
        raise InvalidInput(f"{path} is not the manifest of a dataset")
    return held


def check_same(folder: Path, held: Manifest, wanted: Manifest) -> None:
    """Check that a folder's dataset is the one that is to be made.

    Raises
    ------
    InvalidInput
        It is another; the message says in what they differ.
    """
    differences = [
        *_differences("", held, wanted, skip=("complete", "options", "objects")),
        *_differences("", held.get("options"), wanted["options"]),
        *_differences("object ", held.get("objects"), wanted["objects"]),
    ]
    if differences:
        raise InvalidInput(
            f"{folder} holds another dataset: {'; '.join(differences[:5])}. Name another folder, "
            "or remove this one"
        )


def _differences(
    prefix: str, held: object, wanted: Manifest, skip: Sequence[str] = ()
) -> list[str]:
    if not isinstance(held, dict):
        return [f"{prefix or 'its manifest '}has no entries"]
    return [
        f"{prefix}{key} {_difference(held.get(key), wanted.get(key))}"
        for key in sorted(held.keys() | wanted.keys())
        if key not in skip and held.get(key) != wanted.get(key)
    ]


def _difference(held: object, wanted: object) -> str:
    if isinstance(held, dict) and isinstance(wanted, dict):
        changed = [key for key in sorted(held.keys() | wanted) if held.get(key) != wanted.get(key)]
        return f"differs in {', '.join(changed)}"
    if isinstance(held, dict) or isinstance(wanted, dict):
        return "is only in one of the two"
    return f"is {held!r}, not {wanted!r}"
