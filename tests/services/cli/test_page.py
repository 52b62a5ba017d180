"""The page of an answer: all of it in one file, and drawn by a real browser without a network."""

from __future__ import annotations

import base64
import io
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
import zstandard
from matplotlib.colors import to_rgb
from PIL import Image

from services.cli.ask import Answered
from services.cli.saving.page import write_page
from shared.client import Sparge
from shared.geometry.points import points_from_depth
from shared.grippers.library import load_grippers
from shared.palette import PART_COLOURS, REGION
from tests.support.browser import chromium
from tests.support.samples import sample_view
from tests.support.serving import Client

LARGEST_BYTES = 2_000_000


def answered(backend: Client, task: str) -> Answered:
    view = sample_view("bottle")
    result = Sparge(backend.request).grasp(view, task, max_grasps=3)
    points = points_from_depth(view["depth"], view["intrinsics"], view["depth_scale"])
    return Answered("bottle", result, points, load_grippers()["panda"])


@pytest.fixture(scope="module")
def found(backend: Client) -> Answered:
    return answered(backend, "pouring")


def messages(page: str) -> list[dict[str, Any]]:
    """Return the scene that a page holds, as viser's client reads it."""
    packed = re.search(r'__VISER_EMBED_DATA__="([^"]+)"', page)
    assert packed
    inner = zstandard.ZstdDecompressor().decompressobj().decompress(base64.b64decode(packed[1])[8:])
    length = int.from_bytes(inner[:8], "little")
    held = msgspec.msgpack.decode(inner[8 : 8 + length])
    return [message for _, message in held["messages"]]


def labels(page: str) -> set[str]:
    return {each["props"]["text"] for each in messages(page) if each["type"] == "LabelMessage"}


def names(page: str) -> set[str]:
    return {each["name"] for each in messages(page) if "name" in each}


def test_it_holds_parts_hands_and_reasons(found: Answered, tmp_path: Path) -> None:
    path = tmp_path / "a.html"
    write_page(path, found)
    page = path.read_text()
    assert path.stat().st_size < LARGEST_BYTES
    assert any(text.startswith("0  cylinder") and text.endswith("hold") for text in labels(page))
    assert any(text.startswith("opening") for text in labels(page))
    assert {f"/answer/{each}" for each in ("background", "region", "parts/1", "grasps/2")} <= names(
        page
    )
    assert "<title>bottle, pouring (v2): hold part 0" in page
    assert "<summary>Why</summary>" in page


def test_without_a_region_it_says_why(backend: Client, tmp_path: Path) -> None:
    path = tmp_path / "a.html"
    write_page(path, answered(backend, "hammering"))
    page = path.read_text()
    assert "object_lacks_affordance" in page
    assert "Orange" not in page
    assert not any(name.startswith("/answer/grasps") for name in names(page))
    assert {"/answer/parts/0", "/answer/parts/1"} <= names(page)


def test_texts_of_others_are_no_markup(found: Answered, tmp_path: Path) -> None:
    answer = found.result.answer.model_copy(update={"frame_id": "<script>alert(1)</script>"})
    named = replace(found, name="</title><b>", result=replace(found.result, answer=answer))
    write_page(tmp_path / "a.html", named)
    page = (tmp_path / "a.html").read_text()
    assert "<script>alert" not in page
    assert "</title><b>" not in page


def test_an_empty_view_has_a_page(found: Answered, tmp_path: Path) -> None:
    nothing = replace(
        found.result,
        answer=found.result.answer.model_copy(
            update={"primitives": (), "grasps": (), "region": None}
        ),
        point_primitive=np.full(3, -1, dtype=np.int16),
        point_region=np.zeros(3, dtype=bool),
        grasps=np.empty((0, 9)),
    )
    write_page(tmp_path / "a.html", replace(found, result=nothing, points=np.full((3, 3), np.nan)))
    assert labels((tmp_path / "a.html").read_text()) == set()


@pytest.mark.slow
def test_a_browser_draws_it_offline(found: Answered, tmp_path: Path) -> None:
    write_page(tmp_path / "a.html", found)
    said: list[str] = []
    asked: list[str] = []
    with chromium() as browser:
        page = browser.new_page(viewport={"width": 480, "height": 240}, offline=True)
        page.set_default_timeout(120_000)
        page.on("console", lambda message: said.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: said.append(f"error: {error}"))
        page.on("request", lambda request: asked.append(request.url))
        page.goto((tmp_path / "a.html").as_uri())
        page.wait_for_selector("canvas")
        shares: dict[str, float] = {}
        for _ in range(60):
            page.wait_for_timeout(1000)
            shares = drawn(page.screenshot(), (REGION, PART_COLOURS[1]))
            if min(shares.values()) > 0:
                break
        words = page.inner_text("#sparge")
    assert shares[REGION] > 0.003
    assert shares[PART_COLOURS[1]] > 0.0005
    assert "hold part 0" in words
    assert "wrap_grasp" in words
    assert [each for each in said if each.startswith("error")] == []
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []


def drawn(screenshot: bytes, colours: tuple[str, ...]) -> dict[str, float]:
    """Return the share of pixels with the hue of each colour, right of the panel."""
    with Image.open(io.BytesIO(screenshot)) as image:
        pixels = np.asarray(image.convert("RGB"), dtype=float)[:, 200:].reshape(-1, 3)
    shares = {}
    for colour in colours:
        target = np.array(to_rgb(colour))
        length = np.linalg.norm(pixels, axis=1)
        alike = pixels @ target > 0.985 * length * np.linalg.norm(target)
        shares[colour] = float((alike & (length > 60)).mean())
    return shares
