"""Following a page: every block of it in its order, as a reader would."""

from __future__ import annotations

import ast
import asyncio
import contextlib
import inspect
import json
import re
import tomllib
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import yaml

from shared.settings import PROJECT_ROOT
from tests.docs.checkout import Checkout, Done, captured
from tests.docs.exceptions import Exceptions
from tests.docs.fences import OUTPUT, SHELL, Block, Command, commands
from tests.docs.likeness import difference
from tests.docs.messages import kind_of

AWAIT_ANYWHERE = ast.PyCF_ALLOW_TOP_LEVEL_AWAIT
COMMANDS = re.compile(
    r"^(?:\$ )?(?:sudo |[A-Z_]+=\S+ )*(?:\./|(?:\.venv/bin/)?(?:sparge|python3?|uvicorn)\b|"
    r"(?:make|pip|docker|kubectl|curl|git|apt|apt-get|colcon|ros2) )"
)


@dataclass
class Walk:
    """What a reader has done so far on one page.

    Attributes
    ----------
    checkout : Checkout
        Where.
    exceptions : Exceptions
        What is not run.
    names : dict
        The Python names that the snippets of the page share.
    printed : str
        What the last block printed.
    done : list of str
        What was run, for the tests of this very thing.
    """

    checkout: Checkout
    exceptions: Exceptions
    names: dict[str, Any] = field(default_factory=lambda: {"__name__": "__page__"})
    printed: str = ""
    done: list[str] = field(default_factory=list)

    def follow(self, block: Block) -> None:
        """Do what the block says.

        Raises
        ------
        AssertionError
            It does not work, prints something else, or is nothing that can be run and is
            not listed.
        """
        if block.title == OUTPUT:
            self._compare(block.place, block.text, self.printed)
        elif block.language in SHELL:
            self._shell(block)
        elif block.language in ("python", "py"):
            self._python(block)
        else:
            self._data(block)

    def _shell(self, block: Block) -> None:
        if not block.language:
            command = self.exceptions.command_of_output(block.first_line)
            if command is not None:
                self._type(block.place, Command(command, block.text))
                return
            if self.exceptions.is_text(block.first_line):
                return
        printed = [self._type(block.place, each) for each in commands(block)]
        self.printed = "".join(printed)

    def _type(self, place: str, command: Command) -> str:
        if self.exceptions.is_not_run(command.typed):
            return ""
        run = self.exceptions.command_for(command.typed)
        ended = self.checkout.run(run)
        self.done.append(run)
        said = f"{place}: {run}\nended with {ended.status}\n{ended.stdout}{ended.stderr}"
        assert (ended.status != 0) == command.fails, said
        printed = _seen(ended, command)
        if command.output is not None:
            self._compare(f"{place}: {run}", command.output, printed)
        return printed

    def _python(self, block: Block) -> None:
        if self.exceptions.is_not_run(block.first_line):
            return
        code = compile(self.checkout.here(block.text), block.place, "exec", AWAIT_ANYWHERE)
        with captured() as (out, _), contextlib.chdir(self.checkout.folder):
            if code.co_flags & inspect.CO_COROUTINE:
                asyncio.run(eval(code, self.names))
            else:
                exec(code, self.names)
        self.done.append(block.text)
        self.printed = out.getvalue()

    def _data(self, block: Block) -> None:
        if self.exceptions.is_not_run(block.first_line):
            return
        match block.language:
            case "json":
                content = json.loads(block.text)
                known = kind_of(content) or block.title
                assert known, f"{block.place}: JSON that is no message of the interface"
            case "yaml":
                list(yaml.safe_load_all(block.text))
            case "toml":
                tomllib.loads(block.text)
            case "prolog":
                assert _squeezed(block.text) in _shipped_rules(), f"{block.place}: no shipped rule"
            case "text":
                for line in block.text.splitlines():
                    assert not COMMANDS.match(line), f"{block.place}: a command as text: {line}"
            case other:
                raise AssertionError(f"{block.place}: {other!r} is nothing that the tests can run")
        if block.title:
            path = self.checkout.folder / block.title
            assert not path.exists(), f"{block.place}: {block.title} is there already"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text)
        self.done.append(block.text)

    def _compare(self, place: str, shown: str, printed: str) -> None:
        differs = difference(shown, printed)
        assert differs is None, f"{place}: {differs}\n--- printed:\n{printed}"


@cache
def _shipped_rules() -> str:
    files = sorted((PROJECT_ROOT / "rules").rglob("*.pl"))
    return _squeezed("\n".join(each.read_text(encoding="utf-8") for each in files))


def _squeezed(text: str) -> str:
    return " ".join(text.split())


def _seen(ended: Done, command: Command) -> str:
    """Return what a page shows of it: what goes on beside an output is left out."""
    return ended.stdout + ended.stderr if command.fails or not ended.stdout else ended.stdout
