"""From what a request costs to what a rate of requests needs."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil


@dataclass(frozen=True)
class Size:
    """What a service needs.

    Attributes
    ----------
    cores : float
        That are busy.
    pods : int
        Of one core each, busy for no more than the allowed share.
    memory_gb : float
        10^9 bytes, of all of them.
    megabits : float
        A second, to the service and from it, 10^6 bits.
    """

    cores: float
    pods: int
    memory_gb: float
    megabits: float


def size(rate: float, cpu_ms: float, kilobytes: float, pod_mb: float, share: float) -> Size:
    """Return what `rate` requests a second need.

    Parameters
    ----------
    rate : float
    cpu_ms, kilobytes : float
        Of one request, kilobytes both ways.
    pod_mb : float
        Memory of a pod.
    share : float
        Of its core that a pod may be busy; the rest is headroom.
    """
    cores = rate * cpu_ms / 1e3
    pods = max(1, ceil(cores / share))
    return Size(cores, pods, pods * pod_mb / 1e3, rate * kilobytes * 8 / 1e3)
