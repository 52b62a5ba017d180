"""Every object is one that Kubernetes takes, by the schemas that the project publishes."""

from __future__ import annotations

import copy
from pathlib import Path

import kubernetes_validate
import pytest

from tests.kubernetes.manifests import (
    FOLDER,
    Object,
    base_objects,
    kustomization,
    kustomizations,
    of_kind,
    own_objects,
)

VERSIONS = ("1.27", kubernetes_validate.latest_version())
"""The first with all that is used without a feature gate, and the last that is known."""


@pytest.mark.parametrize("version", VERSIONS)
def test_objects_are_valid(objects: list[Object], version: str) -> None:
    for each in objects:
        kubernetes_validate.validate(each, version, strict=True)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("folder", kustomizations(), ids=lambda each: each.name)
def test_objects_of_overlays_are_valid(folder: Path, version: str) -> None:
    for each in own_objects(folder):
        kubernetes_validate.validate(each, version, strict=True)


def test_a_word_that_is_none_is_seen() -> None:
    gateway = copy.deepcopy(of_kind(base_objects(), "Deployment")["gateway"])
    gateway["spec"]["template"]["spec"]["enableServiceLink"] = False
    with pytest.raises(kubernetes_validate.ValidationError, match="enableServiceLink"):
        kubernetes_validate.validate(gateway, VERSIONS[0], strict=True)


def test_a_kustomization_names_what_is_there() -> None:
    for folder in kustomizations():
        held = kustomization(folder)
        kind = "Component" if folder.parent == FOLDER / "components" else "Kustomization"
        assert held["kind"] == kind
        for name in [*held.get("resources", []), *held.get("components", [])]:
            place = folder / name
            assert place.is_file() or (place / "kustomization.yaml").is_file(), place
