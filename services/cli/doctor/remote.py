"""What runs elsewhere: a stage with a URL, a whole backend."""

from __future__ import annotations

import time
from collections.abc import Iterator
from email.utils import parsedate_to_datetime

import httpx
from pydantic import SecretStr, ValidationError

from services.cli.doctor.finding import Finding, Status
from services.cli.doctor.question import ask
from shared import __version__
from shared.client import connect, key_headers
from shared.errors import SpargeError
from shared.service.secret import secret_headers
from shared.settings import ServiceSettings

_TIMEOUT_S = 5.0
_SKEW_S = 3.0


def service(name: str, url: str, setting: str) -> Iterator[Finding]:
    """Check that the service `name` answers at `url` and is ready.

    Parameters
    ----------
    setting : str
        What the URL comes from, for the advice.
    """
    advice = f"is it running, and is {setting} right?"
    try:
        headers = key_headers() if name == "gateway" else secret_headers(_secret())
        with httpx.Client(base_url=url, timeout=_TIMEOUT_S, headers=headers) as http:
            version = http.get("/version")
            about = version.json()
            health = http.get("/health/ready").json()
            who, build, status = about["service"], about["version"], health["status"]
    except httpx.HTTPError as error:
        message = f"{url} cannot be reached: {error or type(error).__name__}"
        yield Finding(name, Status.fail, message, advice)
        return
    except (ValueError, KeyError, TypeError):
        yield Finding(name, Status.fail, f"{url} is no service of SPaRGE", advice)
        return
    if who != name:
        yield Finding(name, Status.fail, f"{url} is the service {who}", f"correct {setting}")
        return
    if status != "ready":
        why = "; ".join(f"{key}: {text}" for key, text in health.get("details", {}).items())
        level = Status.warn if status == "starting" else Status.fail
        yield Finding(name, level, f"{url} is {status}: {why or 'no reason given'}", "see its log")
    else:
        yield Finding(name, Status.ok, f"{url} is ready, version {build}")
    if build != __version__:
        message = f"{url} runs version {build}, this is {__version__}"
        yield Finding(f"{name} version", Status.warn, message, "deploy one version everywhere")
    yield from _clock(name, version.headers.get("date"))


def _secret() -> SecretStr | None:
    try:
        return ServiceSettings().stage_secret
    except ValidationError:  # told as a finding of the configuration
        return None


def _clock(name: str, date: str | None) -> Iterator[Finding]:
    if not date:
        return
    skew_s = abs(time.time() - parsedate_to_datetime(date).timestamp())
    if skew_s > _SKEW_S:
        message = f"its clock and this one differ by {skew_s:.0f} s"
        yield Finding(f"{name} clock", Status.warn, message, "set both (NTP): logs go by it")


def metrics(url: str) -> Iterator[Finding]:
    """Check that a backend can be scraped."""
    try:
        text = httpx.get(f"{url}/metrics", timeout=_TIMEOUT_S, headers=key_headers()).text
    except httpx.HTTPError as error:
        yield Finding("metrics", Status.warn, str(error) or type(error).__name__)
        return
    if "sparge_requests_total" in text:
        yield Finding("metrics", Status.ok, f"{url}/metrics, {len(text.splitlines())} lines")
    else:
        yield Finding("metrics", Status.warn, f"{url}/metrics has none of SPaRGE's")


def question(url: str) -> Iterator[Finding]:
    """Ask a backend about a bundled view."""
    try:
        with connect(url) as sparge:
            yield Finding("question", Status.ok, ask(sparge))
    except (SpargeError, ValueError) as error:
        advice = "its log has more under the request's id"
        yield Finding("question", Status.fail, str(error), advice)
