"""How the client of a service reaches it over a socket."""

from __future__ import annotations

import httpx

KEEPALIVE_S = 3.0
"""An idle connection is given up before uvicorn gives it up, which it does after 5 s: a request
on a connection that is just being closed is lost."""


class Network(httpx.AsyncHTTPTransport):
    """Sockets whose connections are closed after a number of requests.

    Replicas of a service stand behind one address, and what stands before them, Docker's DNS or
    kube-proxy, shares out connections, not requests. A connection that is kept for good would
    leave a replica that joins later without work, and hold to one that is about to end.

    Parameters
    ----------
    requests_per_connection : int
        How many go over one connection on average before it is closed. 1: each has its own.
    """

    def __init__(self, requests_per_connection: int) -> None:
        limits = httpx.Limits(
            max_connections=64, max_keepalive_connections=16, keepalive_expiry=KEEPALIVE_S
        )
        super().__init__(retries=1, limits=limits)
        self._every = requests_per_connection
        self._requests = 0

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        """Send a request; every so many-th also asks the other side to close the connection."""
        self._requests += 1
        if self._requests % self._every == 0:
            request.headers["Connection"] = "close"
        return await super().handle_async_request(request)
