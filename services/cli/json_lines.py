"""On which line of a JSON text each of its values begins."""

from __future__ import annotations

import json
import re

_SPACE = re.compile(r"[ \t\r\n]*")
_DECODER = json.JSONDecoder()


def lines_of(text: str) -> dict[str, int]:
    """Return the line of every value by its path, as in `conditions.2.value`.

    Parameters
    ----------
    text : str
        JSON that can be parsed. The whole has the path ''.
    """
    lines: dict[str, int] = {}
    _value(text, 0, "", lines)
    return lines


def line_for(path: str, lines: dict[str, int]) -> int:
    """Return the line of a value; of the nearest one around it when it is not there."""
    while path not in lines:
        path = path.rpartition(".")[0]
    return lines[path]


def _value(text: str, start: int, path: str, lines: dict[str, int]) -> int:
    """Note the value at `start` and all in it; return where it ends."""
    start = _skip(text, start)
    lines[path] = text.count("\n", 0, start) + 1
    if text[start] not in "{[":
        return _DECODER.raw_decode(text, start)[1]
    at, number = _skip(text, start + 1), 0
    while text[at] not in "}]":
        key = str(number)
        if text[start] == "{":
            key, at = _DECODER.raw_decode(text, at)
            at = _skip(text, at) + 1
        at = _skip(text, _value(text, at, f"{path}.{key}".lstrip("."), lines))
        if text[at] == ",":
            at = _skip(text, at + 1)
        number += 1
    return at + 1


def _skip(text: str, at: int) -> int:
    match = _SPACE.match(text, at)
    return at if match is None else match.end()
