"""Made-up requests to a service, and its answers held against its OpenAPI document.

Two sources: Schemathesis makes them up from the document, some that its schemas allow and
some that they do not; and true requests are changed in a few places, which gets further in.
Half of the JSON bodies travel as npz where that is taken, arrays as arrays and some of them
with a NaN, for no schema says what an archive may hold.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any, Literal, get_args

import httpx
import numpy as np
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st
from schemathesis import APIOperation, Case, GenerationMode
from schemathesis.core.result import Err, Ok
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from shared.wire import JSON, NPZ
from shared.wire.codec import ENVELOPE
from shared.wire.npz import write_npz
from tests.support.mutation import mutated
from tests.support.serving import Client

AnyCase = Case[Any]
Operation = APIOperation[Any, Any, Any, Any]
Spelling = Literal["JSON", "npz", "npz with NaN"]
SPELLINGS: tuple[Spelling, ...] = ("JSON", *get_args(Spelling))
CHECKS = [
    status_code_conformance,
    content_type_conformance,
    response_headers_conformance,
    response_schema_conformance,
]
BASE = "http://127.0.0.1"


class Explorer:
    """Asks one service, one request after the other.

    Parameters
    ----------
    client : Client
        Of the running service.
    seed : int
        The same seed makes the same requests.

    Attributes
    ----------
    statuses : Counter
        How often each HTTP status came back.
    """

    def __init__(self, client: Client, seed: int) -> None:
        self._client = client
        self._seed = seed
        document = client.request("GET", "/openapi.json").json()
        found = schemathesis.openapi.from_dict(document).get_all_operations()
        self._operations: list[Operation] = [_operation(each) for each in found]
        self.statuses: Counter[int] = Counter()

    def from_schemas(self, cases: int) -> None:
        """Send at least so many requests that are made up from the document.

        Operations without input are asked once; the others share the rest.

        Raises
        ------
        AssertionError
            An answer is a fault of ours, or one that the document does not have.
        """
        varied = [each for each in self._operations if _takes_input(each)]
        share = -(-cases // (len(varied) * len(GenerationMode)))
        for operation in self._operations:
            if operation not in varied:
                self._judge(operation.Case(), "JSON")
                continue
            for mode in GenerationMode:
                self._send_some(operation, mode, share)

    def from_examples(self, examples: Mapping[str, Any], cases: int) -> None:
        """Send so many changed copies of true requests.

        Parameters
        ----------
        examples : mapping
            JSON bodies by the label of their operation, as in `POST /grasp`.
        cases : int
            The operations take turns.

        Raises
        ------
        AssertionError
            As `from_schemas`.
        """
        rng = np.random.default_rng(self._seed)
        by_label = {each.label: each for each in self._operations}
        labels = list(examples)
        for number in range(cases):
            label = labels[number % len(labels)]
            body = mutated(examples[label], rng)
            spelling = SPELLINGS[rng.integers(len(SPELLINGS))]
            self._judge(by_label[label].Case(body=body, media_type=JSON), spelling)

    def _send_some(self, operation: Operation, mode: GenerationMode, cases: int) -> None:
        @seeded(self._seed)
        @settings(
            max_examples=cases,
            database=None,
            deadline=None,
            phases=[Phase.generate],  # a request that fails is small enough as it is
            suppress_health_check=list(HealthCheck),
            print_blob=False,
        )
        @given(
            case=operation.as_strategy(generation_mode=mode), spelling=st.sampled_from(SPELLINGS)
        )
        def send(case: AnyCase, spelling: Spelling) -> None:
            self._judge(case, spelling)

        send()

    def _judge(self, case: AnyCase, spelling: Spelling) -> None:
        """Send one request and hold the answer against the document."""
        sent = _arguments(case, spelling)
        response = self._client.request(**sent)
        self.statuses[response.status_code] += 1
        assert response.status_code != 500, (
            f"{case.operation.label}: {response.text[:500]}\n{str(sent)[:3000]}"
        )
        case.validate_response(schemathesis.Response.from_httpx(response, verify=True), CHECKS)


def _operation(found: Ok[Operation] | Err[Any]) -> Operation:
    assert isinstance(found, Ok), found.err()
    return found.ok()


def _takes_input(operation: Operation) -> bool:
    return bool(operation.body or operation.query or operation.path_parameters)


def _arguments(case: AnyCase, spelling: Spelling) -> dict[str, Any]:
    """Return what to call a client's `request` with; Schemathesis speaks to `requests`."""
    given = {
        name: value
        for name, value in case.as_transport_kwargs(BASE).items()
        if value is not None and name != "cookies"
    }
    given["path"] = given.pop("url")
    if isinstance(given.get("data"), bytes):
        given["content"] = given.pop("data")
    if "files" in given:
        parts = [_part(*each) for each in given.pop("files")]
        form = httpx.Request("POST", BASE, data=given.pop("data", None), files=parts)
        given["content"] = form.read()
        given["headers"] = {**given["headers"], "Content-Type": form.headers["Content-Type"]}
    if "json" in given:
        body = given.pop("json")
        given["content"] = json.dumps(body).encode()  # with NaN, unlike httpx
        if isinstance(body, dict) and spelling != "JSON" and _takes(case, NPZ):
            given["headers"] = {**given["headers"], "Content-Type": NPZ, "Accept": NPZ}
            given["content"] = as_archive(body, poisoned=spelling == "npz with NaN")
    return given


def _part(name: str, value: Any) -> tuple[str, tuple[str | None, bytes]]:
    filename, content = value[:2] if isinstance(value, tuple) else (name, value)
    return name, (filename, content if isinstance(content, bytes) else str(content).encode())


def _takes(case: AnyCase, media_type: str) -> bool:
    return any(each.media_type == media_type for each in case.operation.body)


def as_archive(fields: dict[str, Any], *, poisoned: bool) -> bytes:
    """Return a JSON object as npz: what is a regular array as one, the rest as the message."""
    arrays = dict(_arrays(fields, poisoned))
    rest = {name: value for name, value in fields.items() if name not in arrays}
    return write_npz({**arrays, ENVELOPE: np.frombuffer(json.dumps(rest).encode(), np.uint8)})


def _arrays(fields: dict[str, Any], poisoned: bool) -> Iterator[tuple[str, np.ndarray]]:
    for name, value in fields.items():
        if not isinstance(value, list) or not name.isidentifier():
            continue
        try:
            array = np.array(value)
        except (ValueError, OverflowError):
            continue
        if array.dtype.kind not in "biuf":
            continue
        if poisoned and array.dtype.kind == "f" and array.size:
            array.flat[array.size // 2] = np.nan
        yield name, array
