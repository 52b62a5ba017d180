"""The manifests under docker/kubernetes, as they are in the files and as kustomize renders them."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import yaml

Object = dict[str, Any]

CHECKOUT = Path(__file__).parents[2]
FOLDER = CHECKOUT / "docker" / "kubernetes"
BASE = FOLDER / "base"
OVERLAYS = tuple(sorted(path.name for path in (FOLDER / "overlays").iterdir()))
_OLDEST_KUSTOMIZE = 5


def kustomizations() -> list[Path]:
    """Return every folder with a kustomization."""
    places = [*FOLDER.rglob("kustomization.yaml"), *CHECKOUT.glob("*/kustomization.yaml")]
    return sorted(path.parent for path in places)


def kustomization(folder: Path) -> Object:
    """Return the kustomization of a folder."""
    held: Object = yaml.safe_load((folder / "kustomization.yaml").read_text())
    return held


def own_objects(folder: Path) -> list[Object]:
    """Return the objects in a folder's own files, lists opened; patches are none."""
    names = kustomization(folder).get("resources", [])
    files = [folder / name for name in names if (folder / name).is_file()]
    return [each for file in files for each in documents(file.read_text())]


def base_objects() -> list[Object]:
    """Return what the base holds, with the names alone of the ConfigMaps that it generates."""
    folders = [
        (BASE / name).resolve()
        for name in kustomization(BASE)["resources"]
        if (BASE / name).is_dir()
    ]
    generated = [
        {"kind": "ConfigMap", "apiVersion": "v1", "metadata": {"name": generator["name"]}}
        for folder in folders
        for generator in kustomization(folder)["configMapGenerator"]
    ]
    return [*generated, *own_objects(BASE)]


def patches(folder: Path) -> Iterator[tuple[Mapping[str, str], Object]]:
    """Yield the patches of a folder, each with its target; without one it names it itself."""
    for entry in kustomization(folder).get("patches", []):
        text = entry["patch"] if "patch" in entry else (folder / entry["path"]).read_text()
        for each in documents(text):
            own = {"kind": each["kind"], "name": each["metadata"]["name"]}
            yield entry.get("target", own), each


def documents(text: str) -> list[Object]:
    """Return the objects in a YAML text, lists opened."""
    found: list[Object] = []
    for document in yaml.safe_load_all(text):
        found += document["items"] if document["kind"] == "List" else [document]
    return found


@cache
def renderer() -> Sequence[str] | None:
    """Return the command that renders a folder, or None where there is none that can."""
    kubectl, kustomize = shutil.which("kubectl"), shutil.which("kustomize")
    if kustomize and _recent(_output(kustomize, "version")):
        return (kustomize, "build")
    if kubectl:
        version = json.loads(_output(kubectl, "version", "--client", "--output=json"))
        if _recent(version.get("kustomizeVersion", "")):
            return (kubectl, "kustomize")
    return None


@cache
def rendered(overlay: str) -> str:
    """Return what kustomize makes of an overlay."""
    command = renderer()
    assert command is not None
    return _output(*command, str(FOLDER / "overlays" / overlay))


def of_kind(objects: Sequence[Object], kind: str) -> dict[str, Object]:
    """Return the objects of a kind by name."""
    return {each["metadata"]["name"]: each for each in objects if each["kind"] == kind}


def pod_of(deployment: Object) -> Object:
    """Return the description of a Deployment's pods."""
    spec: Object = deployment["spec"]["template"]["spec"]
    return spec


def pod_labels(deployment: Object) -> dict[str, str]:
    """Return the labels of a Deployment's pods."""
    labels: dict[str, str] = deployment["spec"]["template"]["metadata"]["labels"]
    return labels


def selects(selector: Mapping[str, Any], labels: Mapping[str, str]) -> bool:
    """Say whether a selector with `matchLabels`, or with nothing for all, means these labels."""
    assert set(selector) <= {"matchLabels"}, "other ways to select are not read here"
    wanted: Mapping[str, str] = selector.get("matchLabels", {})
    return wanted.items() <= labels.items()


def _recent(version: str) -> bool:
    major = version.strip().removeprefix("v").partition(".")[0]
    return major.isdigit() and int(major) >= _OLDEST_KUSTOMIZE


def _output(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout
