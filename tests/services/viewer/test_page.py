"""The page in a real browser, as a person would use it, on the real backend."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from services.viewer.server import serving
from services.viewer.sources import Sources
from shared.client import Sparge
from tests.support.browser import chromium, listening
from tests.support.samples import sample_path
from tests.support.serving import Client, free_ports

VIEWPORT = {"width": 420, "height": 420}
"""Small: a processor draws it."""


@pytest.fixture(scope="module")
def url(backend: Client, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    folder = tmp_path_factory.mktemp("views")
    for name in ("bottle", "saucepan", "spatula"):
        (folder / f"{name}.npz").write_bytes(sample_path(name).read_bytes())
    (folder / "broken.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 9\n")
    (folder / "notes.txt").write_text("no view")
    (port,) = free_ports(1)
    with serving(Sparge(backend.request), Sources(folder), "127.0.0.1", port) as page:
        yield page


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with chromium() as running:
        yield running


@pytest.fixture
def page(browser: Browser, url: str) -> Iterator[Page]:
    """An open page with its first answer, which has nothing to complain of in the end."""
    opened = browser.new_page(viewport=VIEWPORT)  # type: ignore[arg-type]
    complaints = listening(opened)
    opened.goto(url)
    opened.get_by_text("hold part").first.wait_for()
    yield opened
    opened.close()
    assert complaints == []


def choose(page: Page, control: str, option: str) -> None:
    page.get_by_label(control, exact=True).click()
    page.get_by_role("option", name=option, exact=True).click()


def test_a_task_is_chosen_and_its_answer_told(page: Page) -> None:
    choose(page, "View", "bottle.npz")
    choose(page, "Task", "handover")
    page.get_by_text(re.compile(r"handover \(v2\): hold part")).first.wait_for()
    page.get_by_text("margin").first.wait_for()
    choose(page, "Task", "hammering")
    page.get_by_text(re.compile(r"hammering \(v2\): no part of this object fits")).wait_for()
    page.get_by_text("Nearest miss").first.wait_for()
    choose(page, "Reasoning", "v1: a rule per task")
    page.get_by_text(re.compile(r"hammering \(v1\): no part")).wait_for()


def test_a_task_is_taught_and_asked_at_once(page: Page, backend: Client) -> None:
    choose(page, "View", "bottle.npz")
    page.get_by_role("tab", name="Teach").click()
    page.get_by_role("textbox").first.fill("watering")
    choose(page, "Object must", "contain")
    choose(page, "Hold what can", "wrap_grasp")
    page.get_by_role("button", name="Add the task").click()
    page.get_by_role("tab", name="Why").click()
    page.get_by_text(re.compile(r"watering \(v2\): hold part")).first.wait_for()
    assert backend.request("DELETE", "/tasks/watering").status_code == 200


def test_what_the_backend_refuses_is_said_and_the_page_goes_on(page: Page) -> None:
    page.get_by_role("tab", name="Teach").click()
    page.get_by_role("textbox").first.fill("No Name")
    page.get_by_role("button", name="Add the task").click()
    page.get_by_text("invalid_input").first.wait_for()
    choose(page, "View", "broken.ply")
    page.get_by_text("malformed").first.wait_for()
    page.get_by_role("tab", name="Why").click()
    page.get_by_text("hold part").first.wait_for(state="detached")
    choose(page, "View", "spatula.npz")
    page.get_by_text(re.compile(r"spatula\.npz: \d+ parts")).first.wait_for()


def test_a_worse_view_is_answered_anew(page: Page) -> None:
    choose(page, "View", "bottle.npz")
    choose(page, "Task", "pouring")
    page.get_by_text(re.compile(r"bottle\.npz: \d+ parts")).first.wait_for()
    page.get_by_role("tab", name="Disturb").click()
    page.get_by_role("slider").nth(1).press("End")  # nearly all of it is hidden
    page.get_by_text(re.compile(r"bottle\.npz: \d+ parts, 0 grasps")).first.wait_for()
    page.get_by_role("tab", name="Why").click()  # a tab is drawn anew when it is looked at
    page.get_by_text(re.compile(r"pouring \(v2\): no part of this object fits")).first.wait_for()


def test_rejected_hands_are_asked_for_and_a_grasp_is_tried(page: Page) -> None:
    choose(page, "View", "bottle.npz")
    choose(page, "Task", "pouring")
    page.get_by_role("tab", name="Grasps").click()
    page.get_by_label("Rejected hands", exact=True).check()
    page.get_by_text(re.compile(r"grasps, [1-9]\d* hands left out")).first.wait_for()
    page.get_by_role("button", name="Try it in simulation").click()
    page.get_by_text(re.compile("held|slipped|missed|pushed")).first.wait_for()


def test_grasps_in_doubt_are_tried_before_they_are_shown(page: Page) -> None:
    choose(page, "View", "saucepan.npz")
    choose(page, "Task", "cooking")
    page.get_by_text(re.compile(r"cooking \(v2\): hold part")).first.wait_for()
    page.get_by_role("tab", name="Grasps").click()
    page.get_by_label("Try them first", exact=True).check()
    page.get_by_role("tab", name="Why").click()
    page.get_by_text(re.compile(r"Tried in simulation before the answer: rank \d: ")).wait_for()


def test_two_pages_do_not_disturb_each_other(browser: Browser, page: Page, url: str) -> None:
    choose(page, "Task", "handover")
    page.get_by_text(re.compile(r"handover \(v2\): hold part")).first.wait_for()
    other = browser.new_page(viewport=VIEWPORT)  # type: ignore[arg-type]
    other.goto(url)
    other.get_by_text(re.compile(r"pouring \(v2\): hold part")).first.wait_for()
    assert page.get_by_label("Task", exact=True).input_value() == "handover"
    other.close()


def test_nothing_to_look_at_is_an_error(tmp_path: Path) -> None:
    from shared.errors import NotFound

    with pytest.raises(NotFound, match=r"\.npz"):
        Sources(tmp_path)
