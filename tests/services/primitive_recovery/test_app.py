"""The service over HTTP."""

from __future__ import annotations

import numpy as np

from services.primitive_recovery.app import create_app
from shared.schemas.primitive import RECOVER, RecoverRequest
from shared.wire import NPZ, encode
from tests.services.primitive_recovery.clouds import superquadric, surface_points
from tests.support.serving import in_process


def test_it_answers_and_refuses_over_http(rng: np.random.Generator) -> None:
    points = surface_points(superquadric((0.1, 0.1), (0.03, 0.04, 0.05)), 1000, rng)
    headers = {"Content-Type": NPZ}
    with in_process(create_app()) as client:
        body = encode(RecoverRequest(points=points), NPZ)
        good = client.request("POST", RECOVER.path, content=body, headers=headers)
        flat = encode(RecoverRequest(points=points * [1.0, 1.0, 0.0]), NPZ)
        bad = client.request("POST", RECOVER.path, content=flat, headers=headers)
    assert good.status_code == 200
    assert good.json()["primitives"][0]["shape_class"] == "cuboid"
    assert bad.status_code == 422
    assert bad.json()["error"]["code"] == "degenerate_cloud"
