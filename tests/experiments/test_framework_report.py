"""The page of all findings."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from experiments.framework import Experiment, Findings, Image, Plot, Share, Table
from experiments.framework.plots import new_figure, share_bars
from experiments.framework.report import save

RUN = {
    "date": "2026-01-01",
    "command": "sparge experiment regions",
    "seed": "0",
    "machine": "a computer",
}


def findings(name: str) -> Findings:
    figure = new_figure(3, 2)
    share_bars(figure.subplots(), ["pouring"], {"Version 1": [Share(1, 2)], "Version 2": [None]})
    return Findings(
        "It works & how. <b>Really</b>.",
        (Table(name, "Found", ("task", "found"), (("pouring", Share(1, 2)),)),),
        (Plot("bars", "Bars.", figure),),
        records=[{"task": "pouring", "found": "true"}],
        images=(Image("film", "A film.", b"GIF89a", "gif"),),
    )


def experiment(name: str) -> Experiment:
    return Experiment(name, f"About {name}", "Does it?", lambda _: findings(name))


class Links(HTMLParser):
    """Collects what a page refers to."""

    def __init__(self) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.ids: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, Any]]) -> None:
        assert tag not in ("script", "link", "iframe", "b")
        self.targets += [value for name, value in attrs if name in ("src", "href")]
        self.ids += [value for name, value in attrs if name == "id"]


def test_the_page_holds_everything_itself(tmp_path: Path) -> None:
    save(tmp_path, experiment("timing"), findings("t"), RUN)
    page = save(tmp_path, experiment("regions"), findings("r"), RUN).read_text(encoding="utf-8")
    links = Links()
    links.feed(page)
    assert links.ids == ["regions", "timing"]  # in the order of the thesis
    assert sorted(set(links.targets) - {f"#{name}" for name in links.ids}) == sorted(
        {each for each in links.targets if each.startswith("data:image/")}
    )
    assert len([each for each in links.targets if each.startswith("data:image/png")]) == 2
    assert len([each for each in links.targets if each.startswith("data:image/gif")]) == 2
    assert "http" not in re.sub(r"base64,[^\"]*", "", page)
    for text in ("About regions", "It works &amp; how.", "sparge experiment regions", "1/2 (50 %"):
        assert text in page


def test_the_summary_holds_the_tables_and_how_they_were_made(tmp_path: Path) -> None:
    save(tmp_path, experiment("timing"), findings("t"), RUN)
    save(tmp_path, experiment("regions"), findings("r"), RUN)
    page = (tmp_path / "results.md").read_text(encoding="utf-8")
    assert page.index("## About regions") < page.index("## About timing")
    assert page.count("`sparge experiment regions`, 2026-01-01, a computer") == 2
    assert page.count("| pouring | 1/2 (50 %") == 2


def test_findings_are_kept_as_files(tmp_path: Path) -> None:
    save(tmp_path, experiment("regions"), findings("r"), RUN)
    held = {path.name for path in (tmp_path / "regions").iterdir()}
    assert held == {"r.csv", "bars.png", "film.gif", "requests.csv", "tables.md", "findings.json"}
    assert (tmp_path / "regions" / "bars.png").read_bytes().startswith(b"\x89PNG")


def test_a_new_run_replaces_the_old_one_and_nothing_else(tmp_path: Path) -> None:
    save(tmp_path, experiment("regions"), findings("old"), RUN)
    (tmp_path / "regions" / "study.sqlite").write_bytes(b"kept")
    save(tmp_path, experiment("regions"), findings("new"), RUN)
    held = {path.name for path in (tmp_path / "regions").iterdir()}
    assert "old.csv" not in held
    assert {"new.csv", "study.sqlite"} <= held


def test_the_same_findings_make_the_same_page(tmp_path: Path) -> None:
    pages = [
        save(tmp_path / name, experiment("regions"), findings("r"), RUN).read_bytes()
        for name in ("one", "other")
    ]
    assert pages[0] == pages[1]


@pytest.mark.parametrize("content", ["", "{", "[]", '{"files": ["../../escape"]}'])
def test_what_is_not_ours_in_the_folder_does_no_harm(tmp_path: Path, content: str) -> None:
    outside = tmp_path / "escape"
    outside.write_text("kept")
    folder = tmp_path / "results" / "regions"
    folder.mkdir(parents=True)
    (folder / "findings.json").write_text(content)
    page = save(tmp_path / "results", experiment("regions"), findings("r"), RUN)
    assert "About regions" in page.read_text(encoding="utf-8")
    assert outside.exists()
