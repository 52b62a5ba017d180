"""Grasps tried in simulation, the best first, until there is something to see."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from shared.schemas.execution import ExecuteRequest, ExecuteResponse


def until_it_moves(
    execute: Callable[[ExecuteRequest], ExecuteResponse], requests: Iterable[ExecuteRequest]
) -> tuple[ExecuteResponse, ...]:
    """Execute filmed requests in order; go on while the robot finds no way to the grasp.

    Parameters
    ----------
    execute : callable
        As `Sparge.execute`.
    requests : iterable of ExecuteRequest
        With `animate`.

    Returns
    -------
    tuple of ExecuteResponse
        One for each that was tried. Only in the last one anything can have moved, and then it
        has an `animation`.
    """
    tried: list[ExecuteResponse] = []
    for request in requests:
        tried.append(execute(request))
        if tried[-1].animation is not None:
            break
    return tuple(tried)
