"""What MkDocs asks while it builds the site: the pages that are made, the menu, the links."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

REPOSITORY = Path(__file__).parents[2]
for _folder in (REPOSITORY, Path(__file__).parent):
    if str(_folder) not in sys.path:  # MkDocs loads this file by its path alone
        sys.path.insert(0, str(_folder))

import pages  # noqa: E402


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put every page into the menu."""
    assert config.nav is not None
    config.nav = pages.complete(config.nav, Path(config.docs_dir))
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that are not written: front page, notes of the repository, API."""
    for name, text in pages.made(REPOSITORY).items():
        files.append(File.generated(config, name, content=text))
    files.append(File.generated(config, "openapi.json", content=json.dumps(_openapi())))
    return files


def on_page_markdown(markdown: str, page: Page, **_: Any) -> str:
    """Turn links into the repository into links into the site."""
    if page.file.src_uri in pages.WIDE:
        page.meta["hide"] = ["toc"]
    return pages.linked(markdown, page.file.src_uri)


def _openapi() -> dict[str, Any]:
    from services.wiring import create_app

    document: dict[str, Any] = create_app().openapi()
    return document
