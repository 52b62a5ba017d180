"""One request and its answer, as logs and metrics see it."""

from __future__ import annotations

from dataclasses import dataclass

from starlette.types import Scope

ERROR_CODE = "sparge.error_code"
"""Where a scope keeps the code of the error that a request was answered with."""

POLLED = frozenset(
    {
        *("/health/live", "/health/ready", "/metrics"),
        *("/v2/health/live", "/v2/health/ready", "/v2/models/sparge/ready"),
    }
)
"""Routes that machines ask every few seconds; they are neither logged at info nor traced."""

NOTHING_SENT = 499
"""Status of a request that was not answered, as nginx counts a client that is gone."""

IN_PROCESS = ("in-process", 0)
"""The client of a request that did not come over a network: the gateway of this process."""


@dataclass(frozen=True)
class Exchange:
    """What is worth knowing about a request; no body, no header, no query.

    Attributes
    ----------
    method, route : str
        The route is the template, as `/tasks/{name}`, so that names make no new series;
        `unmatched` where there is none.
    status : int
        `NOTHING_SENT` where whoever asked was gone, or out of time.
    seconds : float
        From the first byte of the request to the last of the answer.
    bytes_in, bytes_out : int
        Of the bodies.
    client : str
        The address that the request came from, without its port.
    error_code : str or None
        Of the error tree, where the answer is an error.
    """

    method: str
    route: str
    status: int
    seconds: float
    bytes_in: int
    bytes_out: int
    client: str
    error_code: str | None

    @property
    def inside(self) -> bool:
        """Whether it is a step of a request that this process answers as a whole."""
        return self.client == IN_PROCESS[0]


def exchange(scope: Scope, status: int, seconds: float, bytes_in: int, bytes_out: int) -> Exchange:
    """Return the exchange of a scope that was answered."""
    client = scope.get("client")
    return Exchange(
        method=scope["method"],
        route=getattr(scope.get("route"), "path", "unmatched"),
        status=status,
        seconds=seconds,
        bytes_in=bytes_in,
        bytes_out=bytes_out,
        client=client[0] if client else "",
        error_code=scope.get(ERROR_CODE),
    )
