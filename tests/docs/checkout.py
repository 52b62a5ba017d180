"""A copy of the repository to type commands in, as a person who follows a page has it."""

from __future__ import annotations

import contextlib
import io
import os
import re
import runpy
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from string import Template
from unittest import mock

from shared.settings import PROJECT_ROOT

NOT_LINKED = {"out", "results", ".venv", ".git", ".cache", ".hypothesis", ".state"}
IN_THIS_PROCESS = ("dataset", "grasp", "key", "rule", "task")
TAKES_URL = ("grasp", "task", "rule")
OPERATORS = re.compile(r"[|&;<>$`(){}*?~]|\n")
SPARGE = re.compile(r"^(?:\.venv/bin/)?sparge(?=\s|$)")
MODULE = re.compile(r"^(?:\.venv/bin/)?python -m (?P<name>experiments\.\w+)(?=\s|$)")
EXPORT = re.compile(r"^export (\w+)=(\S+)$")
CHANGES_THE_MACHINE = re.compile(
    r"(?:^|[|;&]\s*)(?:sudo|apt|apt-get|docker|git|kind|kubectl|make|rm|"
    r"(?:\S+/)?pip|(?:\S+/)?python3? -m pip)\s"
)
TIMEOUT_S = 120
CURL = "silent\nshow-error\nfail-with-body\n"
"""So that an error is one, and progress is no output."""


@dataclass(frozen=True)
class Done:
    """How a command ended."""

    status: int
    stdout: str
    stderr: str


@dataclass(frozen=True)
class Checkout:
    """The folder, and the backend that stands for that of `make serve`.

    Attributes
    ----------
    folder : Path
        Links to the repository, with a `.venv/bin` of its own.
    port : int
        Where the backend listens; pages say 8000.
    exported : dict
        Variables that the page has set.
    """

    folder: Path
    port: int
    exported: dict[str, str] = field(default_factory=dict)

    @classmethod
    def make(cls, folder: Path, port: int) -> Checkout:
        """Lay out the links and the commands of `.venv/bin`."""
        for each in PROJECT_ROOT.iterdir():
            if each.name not in NOT_LINKED:
                (folder / each.name).symlink_to(each)
        bin_folder = folder / ".venv" / "bin"
        bin_folder.mkdir(parents=True)
        python = f'#!/bin/sh\nexec {shlex.quote(sys.executable)} "$@"\n'
        scripts = {
            "python": python,
            "python3": python,
            "sparge": f"#!/bin/sh\nexec {shlex.quote(sys.executable)} -c "
            "'from services.cli import main; main()' \"$@\"\n",
        }
        for name, text in scripts.items():
            (bin_folder / name).write_text(text)
            (bin_folder / name).chmod(0o755)
        (folder / ".curlrc").write_text(CURL)
        return cls(folder, port)

    def here(self, text: str) -> str:
        """Return a snippet with the port of this backend."""
        return re.sub(r"\b(127\.0\.0\.1|localhost):8000\b", rf"\1:{self.port}", text)

    def run(self, command: str) -> Done:
        """Run a command; a plain `sparge` in this process, for starting Python takes longest.

        Raises
        ------
        AssertionError
            It would change this machine; such commands are to be listed as not run.
        """
        assert not CHANGES_THE_MACHINE.search(command), f"not to be run by tests: {command}"
        command = self.here(command)
        if (export := EXPORT.match(command)) is not None:
            known = {**os.environ, **self._environment(), "PWD": str(self.folder)}
            self.exported[export[1]] = Template(export[2]).safe_substitute(known)
            return Done(0, "", "")
        if not OPERATORS.search(_unquoted(command)):
            if SPARGE.match(command):
                words = shlex.split(command)[1:]
                if words and words[0] in IN_THIS_PROCESS:
                    return self._sparge(words)
            elif (module := MODULE.match(command)) is not None:
                words = shlex.split(command[module.end() :])
                return self._inside(
                    [module["name"], *words],
                    lambda: runpy.run_module(module["name"], run_name="__main__"),
                )
        done = subprocess.run(
            ["bash", "-c", f"set -eo pipefail\n{command}"],
            cwd=self.folder,
            env=self._environment(),
            capture_output=True,
            text=True,
            timeout=TIMEOUT_S,
            check=False,
            stdin=subprocess.DEVNULL,
        )
        return Done(done.returncode, done.stdout, done.stderr)

    def _environment(self) -> dict[str, str]:
        return {
            **os.environ,
            **self.exported,
            "CURL_HOME": str(self.folder),
            "COLUMNS": "80",
            "PATH": f"{self.folder / '.venv' / 'bin'}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": str(self.folder),
        }

    def _sparge(self, words: list[str]) -> Done:
        from services.cli import main

        if words[0] in TAKES_URL and "--url" not in words and "--help" not in words:
            words = [*words, "--url", f"http://127.0.0.1:{self.port}"]
        return self._inside(["sparge", *words], main)

    def _inside(self, argv: list[str], call: Callable[[], object]) -> Done:
        status = 0
        with (
            captured() as (out, err),
            contextlib.chdir(self.folder),
            mock.patch.object(sys, "argv", argv),
            mock.patch.dict(os.environ, self.exported),
        ):
            try:
                call()
            except SystemExit as end:
                status = end.code if isinstance(end.code, int) else int(bool(end.code))
        return Done(status, out.getvalue(), err.getvalue())


@contextlib.contextmanager
def captured() -> Iterator[tuple[io.StringIO, io.StringIO]]:
    """Catch what this process prints."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        yield out, err


def _unquoted(command: str) -> str:
    return re.sub(r"'[^']*'|\"[^\"$`]*\"", "", command)
