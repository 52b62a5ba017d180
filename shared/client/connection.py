"""Where the backend is, and with which key it is asked."""

from __future__ import annotations

import os

import httpx

from shared.errors import InvalidInput

API_KEY_VARIABLE = "SPARGE_API_KEY"
URL_VARIABLE = "SPARGE_URL"
DEFAULT_URL = "http://127.0.0.1:8000"
"""Where `make serve` listens."""


def key_headers(api_key: str | None = None) -> dict[str, str]:
    """Return the headers that show an API key: this one, or that of the environment, if any."""
    key = api_key or os.environ.get(API_KEY_VARIABLE)
    return {"Authorization": f"Bearer {key}"} if key else {}


def backend_url(url: str | None) -> str:
    """Return `url`, or that of the environment, or `DEFAULT_URL`.

    Raises
    ------
    InvalidInput
        It is no HTTP URL.
    """
    wanted = url or os.environ.get(URL_VARIABLE) or DEFAULT_URL
    try:
        parsed = httpx.URL(wanted)
    except httpx.InvalidURL as error:
        raise InvalidInput(f"{wanted!r} is no URL: {error}", field="url", found=wanted) from None
    if parsed.scheme not in ("http", "https") or not parsed.host:
        raise InvalidInput(
            f"the URL of a backend looks like {DEFAULT_URL}; found {wanted!r}",
            field="url",
            found=wanted,
        )
    return wanted
