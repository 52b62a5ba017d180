"""The client that people use: a view and a task in, the answer with its arrays out.

    from shared.client import Sparge

    sparge = Sparge("http://127.0.0.1:8000")
    grasp = sparge.grasp(points, task="pouring").best

It speaks the public contract only, so it works with any backend. `AsyncSparge` has the same
methods, to be awaited. Errors are those of `shared.errors`; what is asked again by itself is in
`shared.client.retry`.
"""

from shared.client.asynchronous import AsyncSparge
from shared.client.connection import API_KEY_VARIABLE, DEFAULT_URL, URL_VARIABLE, key_headers
from shared.client.headline import headline
from shared.client.parameters import GraspParameters
from shared.client.result import GraspResult, RankedGrasp
from shared.client.retry import RetryPolicy
from shared.client.sync import Sparge, connect
from shared.geometry.transform import Transform

__all__ = [
    "API_KEY_VARIABLE",
    "DEFAULT_URL",
    "URL_VARIABLE",
    "AsyncSparge",
    "GraspParameters",
    "GraspResult",
    "RankedGrasp",
    "RetryPolicy",
    "Sparge",
    "Transform",
    "connect",
    "headline",
    "key_headers",
]
