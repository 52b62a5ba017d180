"""The secret that the gateway and its stages share, where there is one."""

from __future__ import annotations

import hmac

from pydantic import SecretStr
from starlette.datastructures import Headers
from starlette.types import Scope

from shared.errors import Unauthorized

_OPEN = "/health/"


def secret_headers(secret: SecretStr | None) -> dict[str, str]:
    """Return the headers of a request to a stage."""
    return {} if secret is None else {"Authorization": f"Bearer {secret.get_secret_value()}"}


class SecretGuard:
    """Lets only requests with the secret pass; all of them where there is none.

    Health checks need none.
    """

    def __init__(self, secret: SecretStr | None) -> None:
        self._wanted = secret_headers(secret).get("Authorization", "").encode()

    def __call__(self, scope: Scope) -> None:
        """Return if the request may pass.

        Raises
        ------
        Unauthorized
            The secret is missing or another.
        """
        if not self._wanted or scope["path"].startswith(_OPEN):
            return
        given = Headers(scope=scope).get("authorization", "").encode("latin-1")
        if not hmac.compare_digest(given, self._wanted):
            raise Unauthorized(
                "this stage answers its gateway only; the secret they share is wrong"
            )
