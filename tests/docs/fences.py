"""The fenced blocks of a page, and the commands in those that are for a shell."""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

FENCE = re.compile(r"^(?P<indent> *)(?P<marks>`{3,}|~{3,})(?P<info>[^`]*)$")
TITLE = re.compile(r"title=\"([^\"]*)\"")
COMMENT = re.compile(r"\s+#\s.*$|^#\s.*$")
SHELL = ("", "sh", "bash", "shell", "console")
OUTPUT = "output"


@dataclass(frozen=True)
class Block:
    """What stands between two fences.

    Attributes
    ----------
    page : str
        The page, from the repository's top.
    line : int
        Of the opening fence, from 1.
    language : str
        As written; "" if nothing is.
    title : str
        `title="..."` after the language: of JSON and text the name of the file that it
        is, or `output`: what the block before prints.
    text : str
    """

    page: str
    line: int
    language: str
    title: str
    text: str

    @property
    def place(self) -> str:
        """Where it is, for a message."""
        return f"{self.page}:{self.line}"

    @property
    def first_line(self) -> str:
        """By which the list of exceptions names it."""
        return next((line.strip() for line in self.text.splitlines() if line.strip()), "")


@dataclass(frozen=True)
class Command:
    """What a person types, and what the page says that it prints (None: nothing is said)."""

    text: str
    output: str | None = None

    @property
    def typed(self) -> str:
        """The command without a comment at its end, lines joined."""
        return re.sub(r"\s*\\\n\s*", " ", COMMENT.sub("", self.text)).strip()

    @property
    def fails(self) -> bool:
        """Whether the page says so, in a comment that begins with `fails`."""
        return bool(re.search(r"#\s*fails\b", self.text))


def blocks(page: Path, root: Path) -> list[Block]:
    """Return the fenced blocks of a page in their order."""
    found: list[Block] = []
    name, lines = page.relative_to(root).as_posix(), page.read_text(encoding="utf-8").splitlines()
    opening: tuple[int, re.Match[str]] | None = None
    body: list[str] = []
    for number, line in enumerate(lines, 1):
        match = FENCE.match(line)
        if opening is None:
            if match:
                opening, body = (number, match), []
            continue
        marks, indent = opening[1]["marks"], opening[1]["indent"]
        if match and match["marks"].startswith(marks) and not match["info"].strip():
            info = opening[1]["info"].strip()
            title = TITLE.search(info)
            language = info.split()[0] if info else ""
            text = "\n".join(body) + "\n"
            found.append(Block(name, opening[0], language, title[1] if title else "", text))
            opening = None
        else:
            body.append(line.removeprefix(indent))
    assert opening is None, f"{name}:{opening and opening[0]}: this fence is not closed"
    return found


def commands(block: Block) -> list[Command]:
    """Return the commands of a block: after `$ ` with what they print, or one after another."""
    lines = block.text.splitlines()
    if not any(line.startswith("$ ") for line in lines):
        return [Command(each) for each in _complete(lines)]
    found: list[tuple[str, list[str]]] = []
    for line in lines:
        if line.startswith("$ "):
            found.append((line[2:], []))
        elif found and not found[-1][1] and not is_complete(found[-1][0]):
            found[-1] = (found[-1][0] + "\n" + line.removeprefix("> "), [])
        elif found:
            found[-1][1].append(line)
        else:
            raise AssertionError(f"{block.place}: output before the first command")
    return [Command(text, "\n".join(printed) if printed else None) for text, printed in found]


def is_complete(text: str) -> bool:
    """Return whether a shell would run this, or wait for another line."""
    if COMMENT.sub("", text).endswith("\\"):
        return False
    read = subprocess.run(["bash", "-n", "-c", text], capture_output=True, text=True, check=False)
    return (
        "unexpected end of file" not in read.stderr
        and "here-document" not in read.stderr
        and "unexpected EOF" not in read.stderr
    )


def _complete(lines: list[str]) -> list[str]:
    found: list[str] = []
    pending = ""
    for line in lines:
        if not pending and (not line.strip() or line.lstrip().startswith("#")):
            continue
        pending = f"{pending}\n{line}" if pending else line
        if is_complete(pending):
            found.append(pending)
            pending = ""
    assert not pending, f"a command without an end: {pending}"
    return found
