"""From the repository to the site: which pages there are, and where their links lead."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

FRONT, DECISIONS, API = "index.md", "decisions/index.md", "api.md"
OF_THE_REPOSITORY = ("CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md")
LINK = re.compile(r"(?<=\]\()(?!https?:|mailto:|#)([^)\s#]+)(#[^)\s]*)?(?=\))")
WIDE = ("comparison.md", "results.md", API)
"""Pages whose tables need the room of the list of headings."""
REFERENCE = """# API reference

Every endpoint of the gateway, from the OpenAPI document that a running backend serves under
`/openapi.json`, made from the code when this site was built ([the document](openapi.json)). What it
cannot say, frames, bodies and errors, is in [HTTP](http-api.md).

<swagger-ui src="openapi.json"/>
"""


def made(repository: Path) -> dict[str, str]:
    """Return the pages that no file under docs/ holds, by their place in the site."""
    texts = {name: (repository / name).read_text(encoding="utf-8") for name in OF_THE_REPOSITORY}
    texts[FRONT] = (repository / "README.md").read_text(encoding="utf-8")
    notes = sorted((repository / "docs" / "decisions").glob("[0-9]*.md"))
    lines = [f"- [{title(note)}]({note.name})" for note in notes]
    texts[DECISIONS] = (
        "# Decisions\n\nWhy it is as it is: what was chosen, against what, and what it costs. "
        "The figures are those of the day.\n\n" + "\n".join(lines) + "\n"
    )
    texts[API] = REFERENCE
    return texts


def complete(nav: list[Any], docs: Path) -> list[Any]:
    """Return the menu with the decision notes, and in its last section what nobody named."""
    sections = [dict(each) for each in nav]
    notes = [f"decisions/{each.name}" for each in sorted((docs / "decisions").glob("[0-9]*.md"))]
    named = set(_paths(nav))
    others = sorted(each.name for each in docs.glob("*.md") if each.name not in named)
    for section in sections:
        if "Decisions" in section:
            section["Decisions"] = [DECISIONS, *notes]
    last = next(reversed(sections[-1]))
    sections[-1][last] = [*sections[-1][last], *others]
    return sections


def linked(markdown: str, page: str) -> str:
    """Return a page's text with its links as they are in the site.

    Parameters
    ----------
    page : str
        Where the page is in the site; those of the repository's top level stand
        beside those of docs/.
    """
    at_the_top = page in OF_THE_REPOSITORY or page == FRONT
    folder = "" if at_the_top else posixpath.join("docs", posixpath.dirname(page))

    def moved(match: re.Match[str]) -> str:
        if page in (DECISIONS, API):
            return match.group()
        target = posixpath.normpath(posixpath.join(folder, match.group(1)))
        here = posixpath.dirname(page) or "."
        return posixpath.relpath(in_site(target), here) + (match.group(2) or "")

    return LINK.sub(moved, markdown)


def in_site(target: str) -> str:
    """Return where a file of the repository is in the site."""
    if target == "README.md":
        return FRONT
    if target == "docs/decisions":
        return DECISIONS
    return target.removeprefix("docs/")


def title(page: Path) -> str:
    """Return what a page's first heading says."""
    with page.open(encoding="utf-8") as lines:
        return next(lines).lstrip("# ").strip()


def _paths(nav: Any) -> Iterator[str]:
    if isinstance(nav, str):
        yield nav
    elif isinstance(nav, dict):
        for each in nav.values():
            yield from _paths(each)
    else:
        for each in nav:
            yield from _paths(each)
