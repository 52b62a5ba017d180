"""Connections to services on other hosts, and when to give one up."""

from __future__ import annotations

import socket
import sys

import httpx

from shared.service.balance import BalancedTransport

LIMITS = httpx.Limits(max_connections=256, max_keepalive_connections=64, keepalive_expiry=3.0)
"""Of connections to stages. An idle one is given up before uvicorn does, after 5 s: a request on a
connection that is just being closed is lost."""
CONNECT_S = 3.0
"""How long to try an address; a host that is gone answers nothing at all."""


def network() -> httpx.AsyncBaseTransport:
    """Return a transport to services on other hosts, spread over their replicas."""
    return BalancedTransport(
        httpx.AsyncHTTPTransport(limits=LIMITS, socket_options=until_gone(CONNECT_S))
    )


def until_gone(seconds: float) -> list[tuple[int, int, int]]:
    """Return socket options that break a connection whose other host is silent for so long.

    A process that dies closes its connections; a host or a container that vanishes does not, and
    a request to it would hang until its deadline. The host's kernel answers the probes, however
    long the process works.
    """
    options = [(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)]
    if sys.platform == "linux":
        options += [
            (socket.IPPROTO_TCP, socket.TCP_KEEPIDLE, 1),
            (socket.IPPROTO_TCP, socket.TCP_KEEPINTVL, 1),
            (socket.IPPROTO_TCP, socket.TCP_KEEPCNT, max(1, round(seconds) - 1)),
            (socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, round(1e3 * seconds)),  # of what is sent
        ]
    return options
