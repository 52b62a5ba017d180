"""The tests of the gateway's contract, put to it over gRPC."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.services.gateway import test_bad_input, test_grasp, test_rehearsal
from tests.support.grpc_as_http import GrpcAsHttp
from tests.support.grpc_calls import Through, grpc_server
from tests.support.serving import Client

NO_CALLS = {
    "test_nan_in_json_is_malformed",  # a message has no JSON
    "test_a_form_without_a_file",
    "test_a_missing_stage_is_named",  # of the gateway alone
    "test_a_request_to_a_missing_stage_names_it",
    "test_requests_side_by_side_do_not_mix",  # of the gateway again, and long
    "test_it_still_answers_after_all_that",  # 20 more requests that were made one by one
}
"""Tests of what cannot be said over gRPC, or says nothing new there."""

globals().update(
    {
        name: test
        for module in (test_grasp, test_bad_input)
        for name, test in vars(module).items()
        if name.startswith("test_") and name not in NO_CALLS
    }
)


test_rehearsals_are_told = test_rehearsal.test_the_answer_says_what_came_of_the_best_grasps
test_no_rehearsal_is_told = test_rehearsal.test_nothing_is_said_where_nothing_was_rehearsed


@pytest.fixture(scope="module")
def backend(backend: Client) -> Iterator[GrpcAsHttp]:
    """The backend of all tests, behind a gRPC server."""
    with grpc_server(Through(backend), health_s=0.05) as channel:
        yield GrpcAsHttp(channel)
