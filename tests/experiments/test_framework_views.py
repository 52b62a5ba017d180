"""Views as experiments see them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from rich.console import Console

from experiments.framework import Experiment, Findings, ViewSet
from experiments.framework.catalogue_views import catalogue_sets
from experiments.framework.conduct import context_for, view_sets
from experiments.framework.views import NOT_AFFORDED, Thing, load, scan_sets
from shared.errors import InvalidInput


def test_a_dataset_tells_about_its_objects(few_things: ViewSet) -> None:
    classes = {file.object_name: few_things.thing(file).class_name for file in few_things.files}
    assert classes == {
        "bottle1": "bottle",
        "can1": "can",
        "hammer1": "hammer",
        "knife1": "knife",
    }


def test_views_of_one_folder_name_are_told_apart(views_folder: Path, tmp_path: Path) -> None:
    other = tmp_path / views_folder.name
    other.symlink_to(views_folder)
    copy = tmp_path / "copy" / views_folder.name
    copy.parent.mkdir()
    for file in views_folder.glob("*/*.npz"):
        place = copy / file.parent.name / file.name
        place.parent.mkdir(parents=True)
        place.write_bytes(file.read_bytes())
    names = [each.name for each in scan_sets([views_folder, copy])]
    assert len(set(names)) == 2
    assert scan_sets([copy])[0].name == views_folder.name
    assert scan_sets([copy])[0].things == {}


def test_a_folder_without_views_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=r"no <object>/<number>\.npz"):
        scan_sets([tmp_path])


def test_a_set_is_limited_by_object_and_by_task(few_things: ViewSet) -> None:
    twice = ViewSet("twice", (*few_things.files, *few_things.files))
    assert len(twice.limited(1).files) == len(few_things.files)
    assert twice.limited(None) is twice
    assert {file.object_name for file in few_things.serving("cutting").files} == {"knife1"}
    assert few_things.serving("juggling").files == ()


def test_points_truth_and_object_belong_together(few_things: ViewSet) -> None:
    for file in few_things.files:
        view = load(file)
        assert view.points.shape == (view.view.depth.size, 3)
        assert np.isfinite(view.object_points).all()
        covered = sum(view.truth(task).astype(int) for task in view.tasks)
        assert np.asarray(covered).max() >= 1
        assert len(view.truth(view.tasks[0])) == len(view.object_points) > 0


def test_what_gives_no_return_is_not_part_of_the_truth(few_things: ViewSet) -> None:
    view = load(few_things.files[0])
    lost = np.zeros(view.view.depth.shape, dtype=bool)
    lost[:, ::2] = True
    thinned = view.without(lost)
    assert not thinned.view.on_object[lost].any()
    assert not thinned.view.region(view.tasks[0])[lost].any()
    assert (thinned.view.depth[~lost] == view.view.depth[~lost]).all()
    assert view.view.on_object[lost].any()


def test_what_is_known_about_a_thing_decides_what_it_does_not_afford() -> None:
    assert Thing("pan", ("cutting",)).refused_tasks(["cooking"]) == ("cutting",)
    assert Thing().refused_tasks(["cooking", "handover"]) == NOT_AFFORDED["cooking"]
    assert Thing().refused_tasks(["juggling"]) == ()


def test_the_catalogues_views_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("experiments.dataset.choice.CATALOGUE", {"can1": None})
    made: list[int] = []
    told: list[tuple[int, int]] = []
    for _ in range(2):
        told.clear()
        (views,) = catalogue_sets(
            tmp_path, 1, 0, progress=lambda done, total: told.append((done, total))
        )
        made.append(len(told))
        assert views.is_catalogue
        assert [file.object_name for file in views.files] == ["can1"]
    assert made == [2, 1]  # nothing is rendered the second time


def test_variants_and_noise_make_sets_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("experiments.dataset.choice.CATALOGUE", {"can1": None})
    sets = catalogue_sets(tmp_path, 2, 0, noisy=1, variants=1)
    held = {each.name: [(file.object_name, file.number) for file in each.files] for each in sets}
    assert held == {
        "catalogue": [("can1", 0), ("can1", 1)],
        "variants": [("can-v0", 0), ("can-v0", 1)],
        "catalogue, noisy": [("can1", 0)],
        "variants, noisy": [("can-v0", 0)],
    }
    assert all(each.thing(each.files[0]).class_name == "can" for each in sets)
    assert all(each.objects["can-v0"].class_name == "can" for each in sets)
    clean, noisy = (load(each.files[0]) for each in (sets[0], sets[2]))
    assert (clean.view.depth != noisy.view.depth).mean() > 0.1
    np.testing.assert_array_equal(clean.view.camera_from_object, noisy.view.camera_from_object)


def test_an_experiment_gets_the_views_that_it_needs(
    tmp_path: Path, views_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("experiments.dataset.choice.CATALOGUE", {"can1": None})

    def names(
        catalogue: bool, scans: Sequence[Path] = (), *, noisy_views: int = 0, variants: int = 0
    ) -> list[str]:
        sets = view_sets(
            Experiment(
                "it",
                "",
                "",
                lambda _: Findings("", ()),
                noisy_views=noisy_views,
                variants=variants,
            ),
            tmp_path,
            scans,
            catalogue=catalogue,
            limit=1,
            seed=0,
            console=Console(quiet=True),
        )
        assert all(len(each.limited(1).files) == len(each.files) for each in sets)
        return [each.name for each in sets]

    assert names(True) == ["catalogue"]
    assert names(True, [views_folder], noisy_views=5) == [
        "catalogue", "catalogue, noisy", "views_clean",
    ]  # fmt: skip
    assert names(True, variants=1) == ["catalogue", "variants"]
    assert names(False, [views_folder], variants=1) == ["views_clean"]


def test_scans_may_be_asked_about_more_often_than_the_catalogue(few_things: ViewSet) -> None:
    scans = replace(few_things, files=few_things.files * 5)
    catalogue = replace(scans, is_catalogue=True)
    wanted = Experiment("it", "", "", lambda _: Findings("", ()), views_per_object=2, scan_views=4)

    def asked(limit: int | None) -> list[int]:
        context = context_for(
            wanted, cast("Any", None), Console(quiet=True), Path(), (catalogue, scans),
            limit=limit, seed=0, workers=1,
        )  # fmt: skip
        return [len(each.files) // len(few_things.files) for each in context.sets]

    assert asked(None) == [2, 4]
    assert asked(1) == [1, 1]
