"""The snippets that are not run as they stand, from exceptions.toml, each with its reason."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

FILE = Path(__file__).with_name("exceptions.toml")


@dataclass
class Exceptions:
    """What exceptions.toml says; `used` holds what a page has asked for.

    Attributes
    ----------
    not_run : dict
        From a command, or the first line of another block, to why it is not run and where
        it is run instead.
    instead : dict
        From a command to a smaller one that is run in its place.
    text : set
        First lines of blocks without a language that are no commands.
    output_of : dict
        From the first words of such a block to the command that prints it.
    """

    not_run: dict[str, str] = field(default_factory=dict)
    instead: dict[str, str] = field(default_factory=dict)
    text: set[str] = field(default_factory=set)
    output_of: dict[str, str] = field(default_factory=dict)
    used: set[str] = field(default_factory=set)

    def is_not_run(self, snippet: str) -> bool:
        """Return whether a command or a block is listed as not run."""
        return self._looked_up(snippet, snippet in self.not_run)

    def is_text(self, first_line: str) -> bool:
        """Return whether a block without a language is listed as no command."""
        return self._looked_up(first_line, first_line in self.text)

    def command_for(self, command: str) -> str:
        """Return what is run for a command: itself, if nothing smaller is listed."""
        self._looked_up(command, command in self.instead)
        return self.instead.get(command, command)

    def command_of_output(self, first_line: str) -> str | None:
        """Return the command that prints a block, if it is listed as output."""
        for beginning, command in self.output_of.items():
            if first_line.startswith(beginning):
                self._looked_up(beginning, True)
                return command
        return None

    def names(self) -> set[str]:
        """Return every snippet that is listed."""
        return {*self.not_run, *self.instead, *self.text, *self.output_of}

    def _looked_up(self, snippet: str, listed: bool) -> bool:
        if listed:
            self.used.add(snippet)
        return listed


@cache
def read() -> Exceptions:
    """Return the exceptions; every one must say why."""
    listed = tomllib.loads(FILE.read_text(encoding="utf-8"))
    for each in listed["not_run"]:
        assert each["reason"], each
        assert each["elsewhere"], each
    return Exceptions(
        not_run={name: each["reason"] for each in listed["not_run"] for name in each["snippets"]},
        instead={each["command"]: each["run"] for each in listed["instead"]},
        text={line for each in listed["text"] for line in each["first_lines"]},
        output_of={each["begins"]: each["command"] for each in listed["output"]},
    )
