"""The picture: it is drawn whatever the answer holds, and shows what it should."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from numpy.typing import NDArray
from PIL import Image

from services.cli.picture import draw_answer
from services.cli.picture.gripper import is_hidden
from services.cli.picture.style import GRIPPER
from services.cli.picture.view import View
from shared.palette import PART_COLOURS, REGION
from shared.schemas.primitive import Primitive
from shared.superquadric import Superquadric, surface_mesh

UP = (0.0, -0.8, -0.6)
GRASP = np.array([[0.0, 0.0, 0.8, 0.0, 0.0, 0.0, 1.0, 0.05, 0.9]])
SOLIDS = (
    Superquadric((0.2, 1.0), (0.02, 0.02, 0.09), (0.0, 0.0, 0.8), (0.5, 0.5, 0.5, 0.5)),
    Superquadric((1.0, 1.0), (0.04, 0.04, 0.04), (0.12, 0.0, 0.8), (0.0, 0.0, 0.0, 1.0)),
)


def primitive(number: int, solid: Superquadric) -> Primitive:
    return Primitive(
        id=number,
        parameters=tuple(solid.to_vector()),
        shape_class="cylinder",
        shape_probability=1.0,
        full_extents=solid.full_extents,
        residual_mm=0.0,
        support=1,
    )


PRIMITIVES = tuple(primitive(k, solid) for k, solid in enumerate(SOLIDS))
POINTS = np.concatenate([surface_mesh(solid, 30, 40)[0] for solid in SOLIDS])
PART = np.repeat(np.arange(2), len(POINTS) // 2).astype(np.int16)


def draw(
    path: Path,
    region: NDArray[np.bool_] = PART == 0,
    grasps: NDArray[np.float64] = GRASP,
    points: NDArray[np.float64] = POINTS,
) -> NDArray[np.uint8]:
    draw_answer(
        path, points, PART[: len(points)], region[: len(points)], PRIMITIVES, grasps, UP, "t"
    )
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def share_like(image: NDArray[np.uint8], colour: str) -> float:
    """Return the share of pixels whose hue is that of `colour`, at any brightness."""
    pixels = image.reshape(-1, 3).astype(float)
    target = np.array(to_rgb(colour))
    length = np.linalg.norm(pixels, axis=1)
    near = pixels @ target > 0.995 * length * np.linalg.norm(target)
    return float((near & (length > 40)).mean())


def halves(image: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    middle = image.shape[1] // 2
    return image[:, :middle], image[:, middle:]


def test_parts_are_on_the_left_the_region_on_the_right(tmp_path: Path) -> None:
    left, right = halves(draw(tmp_path / "new" / "folder" / "a.png"))
    for colour in PART_COLOURS[:2]:
        assert share_like(left, colour) > 0.005
    assert share_like(left, REGION) < 0.002
    assert share_like(right, REGION) > 0.01
    assert share_like(right, GRIPPER) > 0.001


def test_without_a_region_nothing_is_highlighted(tmp_path: Path) -> None:
    image = draw(tmp_path / "a.png", np.zeros(len(POINTS), bool), np.empty((0, 9)))
    left, right = halves(image)
    assert share_like(left, PART_COLOURS[0]) > 0.005
    assert share_like(right, REGION) == 0.0


def test_a_region_without_grasps_has_no_gripper(tmp_path: Path) -> None:
    with_hand = share_like(halves(draw(tmp_path / "a.png"))[1], GRIPPER)
    without = share_like(halves(draw(tmp_path / "b.png", grasps=np.empty((0, 9))))[1], GRIPPER)
    assert without < with_hand / 3


def test_points_without_return_are_left_out(tmp_path: Path) -> None:
    points = POINTS.copy()
    points[::3] = np.nan
    assert share_like(halves(draw(tmp_path / "a.png", points=points))[0], PART_COLOURS[0]) > 0.005


@pytest.mark.parametrize("count", [0, 1, 2, 5])
@pytest.mark.parametrize("primitives", [(), PRIMITIVES])
def test_few_points_and_no_primitives(
    tmp_path: Path, count: int, primitives: tuple[Primitive, ...]
) -> None:
    rows = slice(0, count)
    path = tmp_path / "a.png"
    draw_answer(path, POINTS[rows], PART[rows], PART[rows] == 0, primitives, GRASP, UP, "few")
    assert path.stat().st_size > 5000


@pytest.mark.parametrize("up", [(0, 0, 0), (0, 0, 1), (0, 0, -2)])
def test_any_up_direction(tmp_path: Path, up: tuple[float, float, float]) -> None:
    path = tmp_path / "a.png"
    draw_answer(path, POINTS, PART, PART == 0, PRIMITIVES, GRASP, up, "up")
    assert path.exists()


def test_the_same_answer_gives_the_same_picture_in_every_thread(tmp_path: Path) -> None:
    paths = [tmp_path / f"{k}.png" for k in range(3)]
    with ThreadPoolExecutor(3) as pool:
        list(pool.map(draw, paths))
    assert len({path.read_bytes() for path in paths}) == 1


def test_what_stands_behind_the_cloud_is_hidden() -> None:
    across, along = np.meshgrid(np.arange(-0.05, 0.05, 0.002), np.arange(-0.05, 0.05, 0.002))
    sheet = np.column_stack([across.ravel(), along.ravel(), np.full(across.size, 0.8)])
    view = View.of(sheet, (), None, UP, np.zeros(3))
    towards_the_eye = view.axes[2]
    middle = np.array([0.0, 0.0, 0.8])
    points = middle + np.outer([-0.03, 0.0, 0.03], towards_the_eye)
    assert is_hidden(points, view, sheet).tolist() == [True, False, False]
    beside = points + 0.3 * view.axes[0]
    assert not is_hidden(beside, view, sheet).any()
    assert not is_hidden(points, view, np.empty((0, 3))).any()


def test_a_sentence_stands_under_the_title(tmp_path: Path) -> None:
    def under_the_title(why: str) -> float:
        path = tmp_path / "a.png"
        draw_answer(path, POINTS, PART, PART == 0, PRIMITIVES, GRASP, UP, "t", why=why)
        with Image.open(path) as image:
            strip = np.asarray(image.convert("L"))[70:110]
        return float((strip < 200).mean())

    assert under_the_title("") == 0.0
    assert under_the_title("Hold it by the handle. " * 40) > under_the_title("Hold it.") > 0.0
