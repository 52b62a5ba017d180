"""Findings on disk, and the one page that shows them all.

Every experiment keeps `results/<name>/`: a CSV file per table, a PNG per plot,
`tables.md`, `requests.csv`, and `findings.json`, from which `results/report.html`
and `results/results.md` are written anew after every run.
"""

from __future__ import annotations

import base64
import html
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from experiments.framework.experiment import GLOSSARY, Experiment, Findings, Image
from experiments.framework.plots import png
from experiments.framework.summary import SUMMARY, summarize
from experiments.framework.tables import csv_text

FINDINGS = "findings.json"
REPORT = "report.html"

_STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff;
       max-width: 68rem; margin: 0 auto; padding: 1.5rem; }
h1 { margin-bottom: 0; } h2 { margin-top: 3rem; border-top: 2px solid #ddd; padding-top: 1rem; }
h3 { margin: 1.6rem 0 .4rem; font-size: 1.05rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .88rem; }
th, td { padding: .25rem .6rem; border-bottom: 1px solid #e4e4e4; text-align: left;
         white-space: nowrap; }
th { background: #f6f6f6; vertical-align: bottom; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
.thesis { color: #35608f; background: #f3f7fc; }
.note, figcaption, dl.run { color: #555; font-size: .88rem; }
.meaning { background: #f4f8f1; border-left: 4px solid #3a8f5c; padding: .7rem 1rem; }
figure { margin: 1.2rem 0; } img { max-width: 100%; height: auto; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1rem; }
dt { font-weight: 600; } dd { margin: 0; overflow-wrap: anywhere; }
"""


def save(results: Path, experiment: Experiment, findings: Findings, run: Mapping[str, str]) -> Path:
    """Write what an experiment found and return the page that shows it.

    Parameters
    ----------
    results : Path
        Folder of all experiments; made if it is not there.
    experiment : Experiment
    findings : Findings
    run : mapping
        When, how and on what it ran.
    """
    folder = results / experiment.name
    folder.mkdir(parents=True, exist_ok=True)
    _clear(folder)
    for table in findings.tables:
        _write(folder / f"{table.name}.csv", table.csv())
    _write(folder / "tables.md", "\n".join(table.markdown() for table in findings.tables))
    pictures = [Image(each.name, each.caption, png(each.figure)) for each in findings.plots]
    pictures += findings.images
    for each in pictures:
        (folder / f"{each.name}.{each.kind}").write_bytes(each.data)
    if findings.records:
        _write(folder / "requests.csv", csv_text([dict(each) for each in findings.records], ()))
    _write(
        folder / FINDINGS,
        json.dumps(
            {
                "title": experiment.title,
                "question": experiment.question,
                "thesis": experiment.thesis,
                "meaning": findings.meaning,
                "run": dict(run),
                "tables": [table.html() for table in findings.tables],
                "markdown": [table.markdown() for table in findings.tables if not table.detail],
                "files": [f"{table.name}.csv" for table in findings.tables]
                + [f"{each.name}.{each.kind}" for each in pictures],
                "plots": [
                    {"file": f"{each.name}.{each.kind}", "caption": each.caption}
                    for each in pictures
                ],
            },
            indent=1,
            ensure_ascii=False,
        ),
    )
    page = results / REPORT
    sections = gathered(results)
    _write(page, compose(results, sections))
    _write(results / SUMMARY, summarize(sections.values()))
    return page


def gathered(results: Path) -> dict[str, dict[str, Any]]:
    """Return what every experiment under `results` found, by name: ORDER first, then others."""
    found = {path.parent.name: path for path in results.glob(f"*/{FINDINGS}")}
    names = [name for name in ORDER if name in found] + sorted(set(found) - set(ORDER))
    return {name: json.loads(found[name].read_text(encoding="utf-8")) for name in names}


def compose(results: Path, sections: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the page of all findings; nothing in it is linked from outside.

    Parameters
    ----------
    results : Path
        Where the pictures lie, in a folder for each experiment.
    sections : mapping
        What each found, by name.
    """
    contents = "\n".join(
        f'<li><a href="#{html.escape(name)}">{html.escape(each["title"])}</a>: '
        f"{html.escape(each['question'])}</li>"
        for name, each in sections.items()
    )
    body = "\n".join(_section(results / name, name, each) for name, each in sections.items())
    words = "\n".join(
        f"<dt>{html.escape(word)}</dt><dd>{html.escape(meaning)}</dd>"
        for word, meaning in GLOSSARY.items()
    )
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>SPaRGE: experiments</title>
<style>{_STYLE}</style>
</head>
<body>
<h1>SPaRGE: experiments</h1>
<p>SPaRGE is given one depth image of an object on a table and a task, and answers which part
of the object to hold and how. Here is how good these answers are: on objects whose parts are
known, asked over the same public interface that a robot uses. Blue columns hold the figures of
the master's thesis that SPaRGE started as, measured on its own objects and computer; they say
which size to expect, and are no race on equal terms.</p>
<ol>
{contents}
</ol>
<details open><summary><strong>The words in the tables</strong></summary>
<dl>
{words}
</dl>
</details>
{body}
</body>
</html>
"""


ORDER = (
    "regions",
    "grasps",
    "timing",
    "extension",
    "demo",
    "tuning",
    "shapes",
    "primitives",
    "robustness",
)
"""Of the experiments on the page: the thesis's, then its appendix, then ours."""


def _section(folder: Path, name: str, held: Mapping[str, Any]) -> str:
    run = "\n".join(
        f"<dt>{html.escape(key)}</dt><dd>{html.escape(value)}</dd>"
        for key, value in held["run"].items()
    )
    thesis = f" ({html.escape(held['thesis'])})" if held["thesis"] else ""
    headline, *others = held["tables"] or [""]
    plots = "\n".join(_figure(folder / plot["file"], plot["caption"]) for plot in held["plots"])
    return f"""<section id="{html.escape(name)}">
<h2>{html.escape(held["title"])}{thesis}</h2>
<p>{html.escape(held["question"])}</p>
<p class="meaning">{html.escape(held["meaning"])}</p>
{headline}
{plots}
{"".join(others)}
<details><summary>How it was run</summary>
<dl class="run">
{run}
</dl>
</details>
</section>"""


def _clear(folder: Path) -> None:
    """Remove what an earlier run wrote, so that no file of it stays beside the new ones."""
    try:
        held = json.loads((folder / FINDINGS).read_text(encoding="utf-8"))
        names = [str(name) for name in held["files"]]
    except (OSError, ValueError, KeyError, TypeError):
        return
    for name in names:
        if Path(name).name == name:
            (folder / name).unlink(missing_ok=True)


def _figure(path: Path, caption: str) -> str:
    try:
        data = base64.b64encode(path.read_bytes()).decode("ascii")
    except OSError:
        return ""
    kind = html.escape(path.suffix.removeprefix("."))
    return (
        f'<figure><img alt="{html.escape(caption)}" src="data:image/{kind};base64,{data}">'
        f"<figcaption>{html.escape(caption)}</figcaption></figure>"
    )


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8", newline="\n")
