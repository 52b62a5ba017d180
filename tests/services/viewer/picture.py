"""Photograph the page for the documentation: `python -m tests.services.viewer.picture`.

Writes docs/images/viewer.png; needs the Chromium that `./setup.sh dev` brings.
"""

from __future__ import annotations

import sys
from pathlib import Path

from playwright.sync_api import Page

from services.cli.view import SAMPLES
from services.viewer.server import serving
from services.viewer.sources import Sources
from services.wiring import embedded
from tests.support.browser import WAIT_MS, chromium

PICTURE = Path(__file__).parents[3] / "docs" / "images" / "viewer.png"

SIZE = {"width": 1500, "height": 840}
SETTLED_MS = 15_000


def photograph(page: Page, url: str, view: str, task: str, path: Path) -> None:
    """Choose a view and a task, wait for the answer, write a PNG."""
    page.set_default_timeout(WAIT_MS)
    page.goto(url)
    page.get_by_text("hold part").first.wait_for()
    for control, option in (("View", view), ("Task", task)):
        page.get_by_label(control, exact=True).click(force=True)
        page.get_by_role("option", name=option, exact=True).click(force=True)
    page.get_by_text(f"{task} (v2)").first.wait_for()
    warning = page.get_by_text("Software WebGL rendering")  # no matter of the page's
    if warning.count():
        page.locator(".mantine-Notification-closeButton").first.click(force=True)
    page.wait_for_timeout(SETTLED_MS)
    page.screenshot(path=path, animations="disabled")


def main() -> None:
    """Write the picture."""
    with (
        embedded() as sparge,
        serving(sparge, Sources(SAMPLES), "127.0.0.1", 8398) as url,
        chromium() as browser,
    ):
        page = browser.new_page(viewport=SIZE)  # type: ignore[arg-type]
        view, task = sys.argv[1:3] if len(sys.argv) > 2 else ("ladle.npz", "scooping")
        photograph(page, url, view, task, PICTURE)


if __name__ == "__main__":
    main()
