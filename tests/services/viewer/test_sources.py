"""What can be looked at, by which name, and to whom it belongs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from services.viewer.sources import Sources
from shared.errors import NotFound, SpargeError, UnreadableFile

NEAR, FAR = b"0 0 1\n0 0.1 1\n", b"0 0 2\n0 0.1 2\n0 0.2 2\n"


def folder(at: Path, **files: bytes) -> Path:
    at.mkdir()
    for stem, data in files.items():
        (at / f"{stem}.xyz").write_bytes(data)
    return at


def test_a_folder_is_its_clouds_without_their_labels(tmp_path: Path) -> None:
    place = folder(tmp_path / "a", cup=NEAR)
    for name in ("cup.labels.npz", "notes.txt"):
        (place / name).write_bytes(b"")
    (place / "deeper.xyz").mkdir()
    assert list(Sources(place)) == ["cup.xyz"]


def test_files_of_one_name_are_told_apart(tmp_path: Path) -> None:
    places = [folder(tmp_path / "a", cup=NEAR, mug=NEAR), folder(tmp_path / "b", cup=FAR)]
    sources = Sources(*places)
    assert sorted(sources) == [str(places[0] / "cup.xyz"), str(places[1] / "cup.xyz"), "mug.xyz"]
    assert [len(sources[str(each / "cup.xyz")]().points) for each in places] == [2, 3]


def test_a_place_named_twice_is_there_once(tmp_path: Path) -> None:
    place = folder(tmp_path / "a", cup=NEAR)
    assert list(Sources(place, place / "cup.xyz")) == ["cup.xyz"]


def test_what_one_page_opens_is_not_on_another(tmp_path: Path) -> None:
    common = Sources(folder(tmp_path / "a", cup=NEAR))
    one, other = common.copy(), common.copy()
    name = one.take_in("cup.xyz", FAR)
    assert name not in other
    assert len(one[name]().points) == 3
    assert len(one["cup.xyz"]().points) == len(other["cup.xyz"]().points) == 2
    assert one.take_in("cup.xyz", NEAR) not in ("cup.xyz", name)


def test_a_file_that_is_gone_is_an_error_of_the_tree(tmp_path: Path) -> None:
    place = folder(tmp_path / "a", cup=NEAR)
    sources = Sources(place)
    (place / "cup.xyz").unlink()
    with pytest.raises(UnreadableFile, match=r"cup\.xyz"):
        sources["cup.xyz"]()


def test_what_is_no_view_is_not_taken_in(tmp_path: Path) -> None:
    sources = Sources(folder(tmp_path / "a", cup=NEAR))
    with pytest.raises(SpargeError):
        sources.take_in("new.ply", b"ply\n")
    assert list(sources) == ["cup.xyz"]


def test_nothing_to_look_at_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(NotFound, match=r"\.npz"):
        Sources(tmp_path)


def test_where_the_sensor_was_is_said_once_for_all(tmp_path: Path) -> None:
    sources = Sources(folder(tmp_path / "a", cup=NEAR), viewpoint=[0.1, 0.2, 0.3])
    np.testing.assert_array_equal(sources["cup.xyz"]().viewpoint, [0.1, 0.2, 0.3])
