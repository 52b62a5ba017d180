"""What only the gateway can count: where a request's time went, and what came of it."""

from __future__ import annotations

from collections.abc import Mapping

from prometheus_client import CollectorRegistry, Counter, Histogram

from shared.schemas.task import Reason, Version

REASONS = frozenset(
    {
        "no_primitives",
        "no_part_matches",
        "object_lacks_affordance",
        "no_grasp_part",
        "every_part_avoided",
        "no_grasps_requested",
        "region_not_visible",
        "no_grasp_in_region",
    }
)
"""The codes of docs/reasons.md; any other counts as `other`, so that no label grows."""

_SECONDS = (
    *(0.001, 0.0025, 0.005, 0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2, 0.3, 0.5, 0.75),
    *(1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 30.0, 60.0),
)
_GRASPS = (0, 1, 2, 3, 5, 10, 20, 50, 100)


class GraspMetrics:
    """Counts answers to POST /grasp; a task's name is never a label, since anyone may add one.

    Parameters
    ----------
    registry : CollectorRegistry
        The gateway's.
    """

    def __init__(self, registry: CollectorRegistry) -> None:
        self._seconds = Histogram(
            "sparge_stage_seconds",
            "Time that POST /grasp spent with a stage, as the gateway sees it",
            ["stage"],
            buckets=_SECONDS,
            registry=registry,
        )
        self._failures = Counter(
            "sparge_stage_errors_total",
            "Calls of a stage in POST /grasp that ended in an error, by its code",
            ["stage", "code"],
            registry=registry,
        )
        self._answers = Counter(
            "sparge_answers_total",
            "Answers to POST /grasp by whether a part to hold was found; an empty one has a reason",
            ["reasoning", "found", "reason"],
            registry=registry,
        )
        self._grasps = Histogram(
            "sparge_answer_grasps",
            "Grasps in an answer to POST /grasp that found a part",
            ["reasoning"],
            buckets=_GRASPS,
            registry=registry,
        )

    def spent(self, timings_ms: Mapping[str, float]) -> None:
        """Count what each stage took of one request, answered or not."""
        for stage, spent_ms in timings_ms.items():
            self._seconds.labels(stage).observe(spent_ms / 1e3)

    def failed(self, stage: str, code: str) -> None:
        """Count a call of a stage that ended in an error."""
        self._failures.labels(stage, code).inc()

    def answered(self, reasoning: Version, found: bool, reason: Reason | None, grasps: int) -> None:
        """Count one answer and its grasps."""
        code = reason.code if reason else ""
        known = code if code in REASONS or not code else "other"
        self._answers.labels(reasoning, str(found).lower(), known).inc()
        if found:
            self._grasps.labels(reasoning).observe(grasps)
