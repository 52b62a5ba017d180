"""A small slice of `make bench`: memory stays where it is."""

from __future__ import annotations

from services.reasoning.reasoner import Reasoner
from tests.bench.soak import WINDOWS, Window, growth, soak


def test_memory_stays_while_requests_pass(reasoner: Reasoner) -> None:
    windows = list(soak(reasoner, 1_200))
    assert [each.requests for each in windows] == [60 * (k + 1) for k in range(WINDOWS)]
    assert windows[-1].rss_mb - windows[WINDOWS // 2].rss_mb < 10
    assert all(0 < each.p50 <= each.p95 <= each.p99 for each in windows)


def test_growth_is_seen() -> None:
    def grown(per_request: float) -> float:
        return growth(
            [
                Window(1000 * k, 200 + 1e-6 * per_request * 1000 * k, 1, 1, 1)
                for k in range(1, WINDOWS + 1)
            ]
        )

    assert abs(grown(0)) < 1e-9
    assert 0.045 < grown(1000) < 0.055  # 1 kB per request over 10,000 requests of 210 MB
