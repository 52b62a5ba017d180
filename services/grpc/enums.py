"""Names of closed sets: `v2` in JSON is `REASONING_V2` in protobuf."""

from __future__ import annotations

import re
from typing import Any

from shared.errors import InvalidInput

_WORDS = re.compile(r"(?<=[a-z])(?=[A-Z])")
UNSPECIFIED = 0


def number(kind: Any, text: str) -> Any:
    """Return the value of the enumeration `kind` for a name of the HTTP interface.

    Raises
    ------
    ValueError
        There is none: proto/sparge.proto lags behind shared/schemas.
    """
    return kind.Value(_prefix(kind) + text.upper())


def text(kind: Any, number: int, field: str) -> str | None:
    """Return the name in the HTTP interface of a value of `kind`; None: unspecified.

    Raises
    ------
    InvalidInput
        The enumeration has no such value.
    """
    if number == UNSPECIFIED:
        return None
    prefix = _prefix(kind)
    names: dict[int, str] = {
        value: name.removeprefix(prefix).lower() for name, value in kind.items() if value
    }
    if number not in names:
        raise InvalidInput(
            f"{field} is {number}, allowed are {', '.join(f'{n} ({v})' for v, n in names.items())}",
            field=field,
            found=number,
            allowed=list(names),
        )
    return names[number]


def _prefix(kind: Any) -> str:
    return f"{_WORDS.sub('_', kind.DESCRIPTOR.name).upper()}_"
