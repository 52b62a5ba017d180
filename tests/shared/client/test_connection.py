"""Where the backend is, and the key."""

from __future__ import annotations

import pytest

from shared.client.connection import DEFAULT_URL, backend_url, key_headers
from shared.errors import InvalidInput


def test_the_url_is_what_was_said_or_that_of_the_environment(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("SPARGE_URL", raising=False)
    assert backend_url(None) == DEFAULT_URL
    monkeypatch.setenv("SPARGE_URL", "https://grasps.example")
    assert backend_url(None) == "https://grasps.example"
    assert backend_url("http://robot:9000") == "http://robot:9000"


@pytest.mark.parametrize("url", ["127.0.0.1:8000", "localhost", "ftp://a", "http://", "http://a:b"])
def test_what_is_no_url_of_a_backend(url: str) -> None:
    with pytest.raises(InvalidInput, match="URL") as caught:
        backend_url(url)
    assert caught.value.details["found"] == url


def test_the_key_is_what_was_said_or_that_of_the_environment(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv("SPARGE_API_KEY", raising=False)
    assert key_headers() == {}
    monkeypatch.setenv("SPARGE_API_KEY", "theirs")
    assert key_headers() == {"Authorization": "Bearer theirs"}
    assert key_headers("mine") == {"Authorization": "Bearer mine"}
