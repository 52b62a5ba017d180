"""Commands within a sentence name what there is: subcommands, options, targets, modules."""

from __future__ import annotations

import importlib.util
import re
import shlex
from pathlib import Path
from typing import Any

import pytest
import typer.main

from services.cli.main import app
from shared.settings import PROJECT_ROOT
from tests.docs.fences import FENCE
from tests.docs.walk import COMMANDS

PAGES = [*sorted(PROJECT_ROOT.glob("*.md")), *sorted((PROJECT_ROOT / "docs").glob("*.md"))]
CODE = re.compile(r"(?<!`)`([^`\n]+)`(?!`)")
TARGET = re.compile(r"^([a-z][a-z-]*):", re.MULTILINE)


def prose(text: str) -> str:
    """Return a page without its fenced blocks."""
    kept, inside = [], False
    for line in text.splitlines():
        if FENCE.match(line):
            inside = not inside
        elif not inside:
            kept.append(line)
    return "\n".join(kept)


def complaint(code: str) -> str | None:
    """Return what is wrong with a command in a sentence; None if nothing, or if it is none."""
    words = code.split()
    if words[0] in ("sparge", ".venv/bin/sparge"):
        return _sparge(shlex.split(code)[1:])
    if words[0] == "make" and len(words) > 1:
        targets = set(TARGET.findall((PROJECT_ROOT / "Makefile").read_text()))
        return None if words[1] in targets else f"make knows no target {words[1]!r}"
    if words[:2] == ["python", "-m"] and len(words) > 2:
        module = words[2]
        found = module.split(".")[0] in ("mkdocs", "pytest") or importlib.util.find_spec(module)
        return None if found else f"there is no module {module!r}"
    return None


def _sparge(words: list[str]) -> str | None:
    command: Any = typer.main.get_command(app)
    while hasattr(command, "commands") and words and not words[0].startswith("-"):
        names = words.pop(0).split("|")  # `sparge task add|list|delete`
        for name in names:
            if name not in command.commands and not name.isupper():
                return f"{command.name} knows no command {name!r}"
        if names[0].isupper():
            return None
        command = command.commands[names[0]]
    options = {name for each in command.params for name in (*each.opts, *each.secondary_opts)}
    for word in words:
        name = word.strip("[]").split("=")[0]
        if name.startswith("--") and name not in options | {"--help"}:
            return f"{command.name} has no option {name!r}"
    return None


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_in_sentences_exist(page: Path) -> None:
    found = [complaint(code) for code in CODE.findall(prose(page.read_text()))]
    assert [each for each in found if each is not None] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_no_command_hides_in_an_indented_block(page: Path) -> None:
    hidden = [
        line
        for line in prose(page.read_text()).splitlines()
        if line.startswith("    ") and COMMANDS.match(line.strip())
    ]
    assert hidden == []


@pytest.mark.parametrize(
    "wrong",
    [
        "sparge grip FILE",
        "sparge grasp FILE --tusk pouring",
        "sparge task forget X",
        "sparge task add|lost",
        "make coffee",
        "python -m experiments.nothing",
    ],
)
def test_what_does_not_exist_is_seen(wrong: str) -> None:
    assert complaint(wrong) is not None


@pytest.mark.parametrize(
    "right",
    [
        "sparge grasp FILE --task TASK [--reasoning v1]",
        "sparge task add|list|delete",
        "sparge experiment NAME",
        "sparge",
        "make run",
        "python -m experiments.pictures gallery",
        "grasp",
    ],
)
def test_what_exists_passes(right: str) -> None:
    assert complaint(right) is None
