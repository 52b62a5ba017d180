"""Whether what a command printed is what its page shows, but for what varies.

What varies is a matter of rules, the same for all pages:

- times, dates, request ids, ports and rates are any;
- numbers with a sign are coordinates of a pose, and any: between grasps that are as good
  as each other the last bits of a processor decide;
- other numbers may differ by a fifth, or by two units of the last digit shown;
- white space, lines of tables and where lines are broken do not count;
- `...` on a page stands for anything.
"""

from __future__ import annotations

import re

RULES = (
    (re.compile(r"^Time\s*\(ms\).*\Z", re.MULTILINE | re.DOTALL), "Time"),
    (re.compile(r"\x1b\[[0-9;]*m"), ""),
    (re.compile(r'"timings_ms":\s*\{[^}]*\}'), '"timings_ms": {}'),
    (re.compile(r'"(request_id|trace_id|span_id)":\s*"[^"]*"'), r'"\1": ""'),
    (
        re.compile(r"\d{4}-\d\d-\d\d(?:[T ]\d\d:\d\d(?::\d\d)?(?:\.\d+)?(?:\+\d\d:\d\d|Z| UTC)?)?"),
        "DATE",
    ),
    (re.compile(r"\b(?:127\.0\.0\.1|localhost):\d+"), "HOST"),
    (re.compile(r"(?<![\w.])\d+(?:\.\d+)? ?(?:ms|s|us|seconds?|kB|MB|GB)\b"), "AMOUNT"),
    (re.compile(r"\bdur=\d+(?:\.\d+)?"), "AMOUNT"),
    (re.compile(r"[─━│┃╭╮╰╯├┤┬┴┼┏┓┗┛┡┩╇╈└┘┌┐╞╡═╪]"), " "),
    (re.compile(r"[+-]\d+(?:\.\d+)?(?:[eE][+-]?\d+)?"), " POSE "),
    (re.compile(r"(?:\.\.\.|…)"), " ELLIPSIS "),
)
TOKEN = re.compile(r"\d+(?:\.\d+)?(?:[eE][+-]?\d+)?|[^\W\d]+|[^\w\s]")
NUMBER = re.compile(r"\d")
RELATIVE, LAST_DIGITS = 0.2, 2.0
COUNTS = 5
"""Whole numbers below are numbers of parts and the like, and have to be the same."""


def tokens(text: str) -> list[str]:
    """Return words, numbers and signs, what varies replaced."""
    for pattern, replacement in RULES:
        text = pattern.sub(replacement, text)
    return TOKEN.findall(text)


def difference(shown: str, printed: str) -> str | None:
    """Return where what was printed differs from what a page shows; None if nowhere."""
    wanted, found = tokens(shown), tokens(printed)
    position = 0
    pieces = _split(wanted)
    for number, piece in enumerate(pieces):
        last, start = number == len(pieces) - 1, position
        begin = len(found) - len(piece) if last and number else position
        places = range(begin, len(found) - len(piece) + 1) if number else [0]
        place = next((at for at in places if at >= start and _agree(piece, found[at:])), None)
        if place is None:
            best = _furthest(piece, found[max(begin, 0) :])
            return f"the page shows {' '.join(best[0])!r} where {' '.join(best[1])!r} was printed"
        position = place + len(piece)
    if position != len(found) and (pieces[-1] or len(pieces) == 1):
        return f"printed, but not on the page: {' '.join(found[position : position + 12])!r}"
    return None


def _split(wanted: list[str]) -> list[list[str]]:
    pieces: list[list[str]] = [[]]
    for token in wanted:
        if token == "ELLIPSIS":
            pieces.append([])
        else:
            pieces[-1].append(token)
    return pieces


def _agree(piece: list[str], found: list[str]) -> bool:
    return len(found) >= len(piece) and all(
        _like(*pair) for pair in zip(piece, found, strict=False)
    )


def _like(shown: str, printed: str) -> bool:
    if not (NUMBER.match(shown) and NUMBER.match(printed)):
        return shown == printed
    one, other = float(shown), float(printed)
    if shown.isdigit() and one < COUNTS:
        return one == other
    digits = len(shown.split(".")[1]) if "." in shown and "e" not in shown.lower() else 0
    return abs(one - other) <= max(RELATIVE * abs(one), LAST_DIGITS * 10.0**-digits) + 1e-12


def _furthest(piece: list[str], found: list[str]) -> tuple[list[str], list[str]]:
    same = 0
    while same < min(len(piece), len(found)) and _like(piece[same], found[same]):
        same += 1
    around = slice(max(same - 4, 0), same + 6)
    return piece[around], found[around]
