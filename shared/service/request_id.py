"""The id of the request being answered, for logs and for calls to other services."""

from __future__ import annotations

import re
import uuid
from contextvars import ContextVar

REQUEST_ID_HEADER = "X-Request-ID"

request_id: ContextVar[str] = ContextVar("request_id", default="-")

_VALID = re.compile(r"[A-Za-z0-9._-]{1,64}")


def identified(given: str) -> str:
    """Return the id that a caller gave, where it can go into logs; else a new one."""
    return given if _VALID.fullmatch(given) else uuid.uuid4().hex
