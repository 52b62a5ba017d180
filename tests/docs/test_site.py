"""The documentation site as `make docs` builds it."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from shared.settings import PROJECT_ROOT

CONFIG = PROJECT_ROOT / "docs" / "site" / "mkdocs.yml"
LOADED = re.compile(
    r"<(?:script|img|iframe|source)[^>]*\ssrc=\"?(?:https?:)?//|<link[^>]*href=\"?(?:https?:)?//"
)


def mkdocs(config: Path, out: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "-f", str(config), "-d", str(out)],
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": str(PROJECT_ROOT)},
        capture_output=True,
        text=True,
        timeout=120,
    )


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the site's folder; the build is strict, so every link leads somewhere."""
    folder = tmp_path_factory.mktemp("site")
    done = mkdocs(CONFIG, folder)
    assert done.returncode == 0, done.stderr
    return folder


def test_every_page_of_the_repository_is_in_it(site: Path) -> None:
    pages = [*(PROJECT_ROOT / "docs").glob("*.md"), *(PROJECT_ROOT / "docs/decisions").glob("*.md")]
    assert len(pages) > 30
    menu = (site / "index.html").read_text()
    for page in pages:
        place = page.relative_to(PROJECT_ROOT / "docs").with_suffix("")
        assert (site / place / "index.html").is_file()
        assert f'href="{place.as_posix()}/"' in menu, f"{place} is not in the menu"


def test_the_front_page_is_the_readme(site: Path) -> None:
    front = (site / "index.html").read_text()
    readme = (PROJECT_ROOT / "README.md").read_text()
    for heading in re.findall(r"^## (.+)$", readme, re.MULTILINE):
        assert heading in front
    assert 'src="images/grasp.png"' in front


def test_nothing_is_loaded_from_elsewhere(site: Path) -> None:
    pages = [*site.rglob("*.html")]
    assert len(pages) > 30
    for page in pages:
        assert not LOADED.search(page.read_text()), page
    for style in site.rglob("*.css"):
        assert not re.search(r"(?:url\(|@import\s)[\"']?(?:https?:)?//", style.read_text()), style


def test_what_is_loaded_from_elsewhere_would_be_seen() -> None:
    assert LOADED.search('<script src="https://unpkg.com/mermaid.js"></script>')
    assert LOADED.search('<link rel="stylesheet" href="//fonts.googleapis.com/css">')
    assert not LOADED.search('<a href="https://arxiv.org/abs/1">paper</a><img src="a.png">')


def test_the_reference_is_that_of_the_code(site: Path) -> None:
    written = json.loads((site / "openapi.json").read_text())
    snapshot = PROJECT_ROOT / "tests" / "contract" / "snapshots" / "gateway.json"
    written["info"].pop("version")
    assert written == json.loads(snapshot.read_text())
    assert "openapi.json" in next((site / "api").glob("swagger-*.html")).read_text()


def test_a_broken_link_fails_the_build(tmp_path: Path) -> None:
    docs = tmp_path / "docs"
    docs.mkdir()
    (docs / "index.md").write_text("# A page\n\n[gone](gone.md)\n")
    config = tmp_path / "mkdocs.yml"
    lines = CONFIG.read_text().split("\nnav:")[0].replace("docs_dir: ..", "docs_dir: docs")
    keep = re.sub(r"hooks:\n  - hooks.py\n", "", lines)
    config.write_text(re.sub(r"extra_css:\n  - .*\n", "", keep))
    done = mkdocs(config, tmp_path / "out")
    assert done.returncode != 0
    assert "gone.md" in done.stderr
