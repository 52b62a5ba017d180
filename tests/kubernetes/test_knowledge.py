"""Rules, ontology and published knowledge as ConfigMaps: complete, small enough, and they work."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from pathlib import Path

import httpx
import pytest

from services.reasoning.change import Change
from services.reasoning.journal import Journal
from shared.schemas.task import TaskDefinition
from tests.kubernetes.manifests import (
    BASE,
    CHECKOUT,
    documents,
    kustomization,
    of_kind,
    own_objects,
    pod_of,
    rendered,
    renderer,
)
from tests.support.processes import READY_TIMEOUT_S, served

MAX_BYTES = 2**20
"""Of a ConfigMap."""
NOT_READ = {".plt", ".yaml"}
"""Tests and the kustomizations themselves."""


def generated(folder: str) -> dict[str, dict[str, bytes]]:
    """Return the ConfigMaps that a folder's kustomization makes: the files by key."""
    return {
        each["name"]: {
            Path(name).name: (CHECKOUT / folder / name).read_bytes() for name in each["files"]
        }
        for each in kustomization(CHECKOUT / folder)["configMapGenerator"]
    }


@pytest.mark.parametrize("folder", ["rules", "ontology"])
def test_every_file_is_in_a_config_map(folder: str) -> None:
    listed = [
        name
        for each in kustomization(CHECKOUT / folder)["configMapGenerator"]
        for name in each["files"]
    ]
    there = [
        str(path.relative_to(CHECKOUT / folder))
        for path in (CHECKOUT / folder).rglob("*")
        if path.is_file() and path.suffix not in NOT_READ
    ]
    assert sorted(listed) == sorted(there)
    for name, held in generated(folder).items():
        assert sum(map(len, held.values())) < MAX_BYTES, name


def test_rendered_config_maps_hold_the_files() -> None:
    if renderer() is None:
        pytest.skip("NOT RENDERED: there is no kubectl or kustomize with kustomize 5 here")
    maps = of_kind(documents(rendered("small")), "ConfigMap")
    for name, files in {**generated("rules"), **generated("ontology")}.items():
        (held,) = (each for key, each in maps.items() if key.rpartition("-")[0] == name)
        assert {key: text.encode() for key, text in held["data"].items()} == files


class MountedConfigMap:
    """A folder as Kubernetes mounts a ConfigMap: links by way of one that is exchanged."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._number = 0
        folder.mkdir(parents=True, exist_ok=True)

    def put(self, files: Mapping[str, bytes]) -> None:
        """Exchange what it holds at once."""
        self._number += 1
        version = self.folder / f"..{self._number}"
        version.mkdir()
        for name, data in files.items():
            (version / name).write_bytes(data)
        new, data_link = self.folder / "..new", self.folder / "..data"
        new.symlink_to(version.name)
        new.replace(data_link)
        for name in files:
            if not (self.folder / name).is_symlink():
                (self.folder / name).symlink_to(Path("..data") / name)


def test_reasoning_works_with_what_is_mounted_and_sees_what_is_published(tmp_path: Path) -> None:
    """The layout is that of the manifest; published knowledge counts without a restart."""
    pod = pod_of(of_kind(own_objects(BASE), "Deployment")["reasoning"])
    (container,) = pod["containers"]
    maps = {**generated("rules"), **generated("ontology")}
    for mount in container["volumeMounts"]:
        if mount["name"] in maps:
            place = tmp_path / mount["mountPath"].lstrip("/")
            MountedConfigMap(place).put(maps[mount["name"]])
    told = {
        each["name"]: str(tmp_path) + each["value"]
        for each in container["env"]
        if each["name"].startswith("SPARGE_REASONING_")
    }
    published = MountedConfigMap(Path(told["SPARGE_REASONING_KNOWLEDGE_DIR"]))
    with (
        served(["reasoning"], {**os.environ, **told}) as running,
        httpx.Client(base_url=running["reasoning"].url) as http,
    ):
        wait_until_ready(http)
        assert "pouring" in tasks(http)
        assert "watering" not in tasks(http)
        published.put({"knowledge.journal": journal_with("watering", tmp_path / "first")})
        assert "watering" in tasks(http)
        published.put({"knowledge.journal": journal_with("sowing", tmp_path / "second")})
        assert "sowing" in tasks(http)
        assert "watering" not in tasks(http), "what is published replaces what was"


def wait_until_ready(http: httpx.Client) -> None:
    deadline = time.monotonic() + READY_TIMEOUT_S
    while time.monotonic() < deadline:
        try:
            health = http.get("/health/ready").json()
        except httpx.TransportError:
            time.sleep(0.1)
            continue
        assert health["status"] != "failed", health
        if health["status"] == "ready":
            return
        time.sleep(0.1)
    raise AssertionError("reasoning did not get ready")


def tasks(http: httpx.Client) -> set[str]:
    return {each["name"] for each in http.get("/tasks").json()["tasks"]}


def journal_with(task: str, folder: Path) -> bytes:
    """Return a journal in which one task was learned."""
    journal = Journal(folder)
    definition = TaskDefinition(name=task, requires=("contain",), grasp=("wrap_grasp",))
    with journal.writing():
        journal.rewrite(Change(clear=True, tasks=(definition,)))
    journal.close()
    return (folder / "knowledge.journal").read_bytes()
