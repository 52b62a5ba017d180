"""Who may ask the gateway: API keys with scopes and rates, or the loopback alone."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, MutableMapping
from typing import Any

from services.gateway.keys import ApiKey, Keyring, Scope
from services.gateway.settings import GatewaySettings
from shared.errors import Forbidden, InvalidInput, RateLimited, Unauthorized
from shared.loopback import is_loopback

AsgiScope = MutableMapping[str, Any]

_OPEN = (
    *("/health/live", "/health/ready"),
    *("/v2/health/live", "/v2/health/ready", "/v2/models/sparge/ready"),
)
_KNOWLEDGE = ("/tasks", "/rules", "/affordances", "/knowledge")
_GRASP = ("/grasp", "/execute", "/v2/models/sparge/infer")


def needed_scope(method: str, path: str) -> Scope | None:
    """Return the scope that a request needs; None: it is open to everybody.

    What is not listed needs `admin`, so that a new endpoint is closed until someone opens it.
    """
    if path in _OPEN:
        return None
    if method in ("GET", "HEAD") or (method, path) == ("POST", "/sparql"):
        return Scope.READ
    if method == "POST" and path in _GRASP:
        return Scope.GRASP
    if method in ("POST", "DELETE") and path.startswith(_KNOWLEDGE):
        return Scope.KNOWLEDGE
    return Scope.ADMIN


class Access:
    """Lets a request in or raises.

    Parameters
    ----------
    settings : GatewaySettings
        With `api_keys_file` every request but the health checks needs a key. Without it only
        the loopback is answered, unless `insecure`.
    clock : callable, optional
        Seconds since some fixed time.

    Raises
    ------
    InvalidInput
        The file of keys cannot be read.
    """

    def __init__(
        self, settings: GatewaySettings, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._insecure = settings.insecure
        self._rate, self._burst = settings.rate_per_s, settings.rate_burst
        self._clock = clock
        self._keyring = None
        if settings.api_keys_file is not None:
            self._keyring = Keyring(settings.api_keys_file, clock)
        self._left: dict[str, tuple[float, float]] = {}

    def __call__(self, scope: AsgiScope) -> None:
        """Return if the request may pass.

        Raises
        ------
        Unauthorized
            No key, or one that is not known.
        Forbidden
            The key does not open this; or no keys are set and the request is not from here.
        RateLimited
            The key asks too often.
        """
        needed = needed_scope(scope["method"], scope["path"])
        if needed is None:
            return
        if self._keyring is None:
            if not self._insecure:
                _require_loopback(scope)
            return
        key = self._keyring.find(_given(scope))
        if key is None:
            raise Unauthorized(
                "this backend wants an API key, as `Authorization: Bearer KEY`; "
                "none was given or it is not known"
            )
        if not key.may(needed):
            raise Forbidden(
                f"the key {key.name!r} opens {', '.join(key.scopes)}; this needs {needed}",
                needed=needed,
                scopes=list(key.scopes),
            )
        self._spend(key)
        scope.setdefault("state", {})["api_key"] = key.name

    def _spend(self, key: ApiKey) -> None:
        """Take one from the key's bucket, which fills at its rate up to the burst."""
        rate = key.rate_per_s or self._rate
        if rate is None:
            return
        now = self._clock()
        full = max(self._burst, 1.0)
        left, then = self._left.get(key.name, (full, now))
        left = min(full, left + rate * (now - then))
        if left < 1:
            self._left[key.name] = left, now
            raise RateLimited(
                f"the key {key.name!r} may ask {rate:g} times a second",
                allowed_per_s=rate,
                retry_after_s=max(1, math.ceil((1 - left) / rate)),
            )
        self._left[key.name] = left - 1, now


def require_guarded(host: str, settings: GatewaySettings) -> None:
    """Return if a gateway with these settings may listen on `host`.

    Raises
    ------
    InvalidInput
        It could be reached from other machines, and nothing guards it.
    """
    if settings.api_keys_file is None and not settings.insecure and not is_loopback(host):
        raise InvalidInput(
            f"without API keys the gateway listens on the loopback only, not on {host}. "
            "Make a key with `sparge key add NAME` and set SPARGE_GATEWAY_API_KEYS_FILE; or say "
            "--insecure to let anybody who reaches it use and change it"
        )


def _require_loopback(scope: AsgiScope) -> None:
    # The address that the request came to is known of every server; a path is a Unix socket.
    server, _ = scope.get("server") or ("localhost", None)
    if not is_loopback(server) and not server.startswith("/"):
        raise Forbidden(
            "this gateway has no API keys and answers on the loopback only; "
            "see SECURITY.md for how to open it"
        )
    # A web page whose name was made to lead here is stopped by the name it asks for.
    asked = _header(scope, b"host")
    if asked and not is_loopback(_without_port(asked)):
        raise Forbidden(f"this gateway answers to the names of the loopback only, not to {asked!r}")


def _given(scope: AsgiScope) -> str:
    kind, _, text = _header(scope, b"authorization").partition(" ")
    return text.strip() if kind.lower() == "bearer" else _header(scope, b"x-api-key")


def _header(scope: AsgiScope, name: bytes) -> str:
    return next((value.decode("latin-1") for key, value in scope["headers"] if key == name), "")


def _without_port(host: str) -> str:
    return host.partition("]")[0] if host.startswith("[") else host.partition(":")[0]
