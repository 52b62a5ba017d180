"""`--save`: pictures, films, and what cannot be saved; against one backend over a socket."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
import typer
from PIL import Image, ImageSequence
from typer.testing import CliRunner, Result

from services.cli.main import app
from services.cli.saving import saved
from shared.client.trying import until_it_moves
from shared.schemas.execution import EXECUTE, ExecuteRequest, ExecuteResponse
from shared.schemas.grasp import Pose
from tests.support.relay import relay
from tests.support.samples import sample_path
from tests.support.serving import Client, serving


@pytest.fixture(scope="module")
def url(backend: Client) -> Iterator[str]:
    with serving(relay(backend)) as at:
        yield at


def grasp(url: str, task: str, files: Sequence[Path], name: str = "bottle") -> Result:
    words = ["grasp", str(sample_path(name)), "--task", task, "--url", url, "--max-grasps", "2"]
    return CliRunner().invoke(
        app, words + [word for file in files for word in ("--save", str(file))]
    )


def test_a_picture_and_a_film(url: str, tmp_path: Path) -> None:
    picture, film = tmp_path / "made" / "a.PNG", tmp_path / "a.gif"
    done = grasp(url, "pouring", [picture, film])
    assert done.exit_code == 0, done.output
    assert "Tried in simulation" in done.output
    assert "lifted" in done.output
    assert f"saved: {picture}" in done.output.replace("\n", "")
    with Image.open(picture) as image:
        assert image.format == "PNG"
    with Image.open(film) as moving:
        assert moving.format == "GIF"
        assert sum(1 for _ in ImageSequence.Iterator(moving)) > 20


def test_without_a_grasp_there_is_no_film(url: str, tmp_path: Path) -> None:
    picture, film = tmp_path / "a.png", tmp_path / "a.gif"
    done = grasp(url, "hammering", [film, picture])
    assert done.exit_code == 1
    assert "not saved" in done.output
    assert "no grasp to execute" in done.output
    assert "object_lacks_affordance" in done.output
    assert not film.exists()
    assert picture.exists()


def test_without_save_nothing_is_executed(url: str) -> None:
    done = grasp(url, "pouring", [])
    assert done.exit_code == 0
    assert "Tried" not in done.output


@pytest.mark.parametrize("name", ["a.jpg", "a", "a.tar.gz"])
def test_an_unknown_suffix_is_told_before_any_work(name: str) -> None:
    done = grasp("http://127.0.0.1:1", "pouring", [Path(name)])
    assert done.exit_code == 2
    for word in (".png", ".html", ".gif"):
        assert word in done.output


def test_what_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "b.png").mkdir()
    with pytest.raises(typer.BadParameter, match="folder"):
        saved([tmp_path / "b.png"])
    with pytest.raises(typer.BadParameter, match="twice"):
        saved([tmp_path / "a.png", tmp_path / "x" / ".." / "a.png"])


def test_grasps_are_tried_until_one_moves() -> None:
    request = ExecuteRequest(
        pose=Pose(position=(0, 0, 0), quaternion=(0, 0, 0, 1)),
        width=0.05,
        primitives=((1, 1, 0.02, 0.02, 0.05, 0, 0, 0, 0, 0, 0, 1),),
        up=(0, 0, 1),
    )
    stuck = ExecuteResponse(
        success=False, lifted=False, outcome="unreachable", message="", lift_height=0.0, phases=()
    )
    moved = stuck.model_copy(update={"outcome": "missed", "animation": b"GIF"})
    answers = iter([stuck, moved, moved])
    assert until_it_moves(lambda _: next(answers), [request] * 3) == (stuck, moved)
    assert until_it_moves(lambda _: stuck, [request] * 2) == (stuck, stuck)
    assert until_it_moves(lambda _: stuck, []) == ()
    assert EXECUTE.changes is False
