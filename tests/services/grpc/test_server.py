"""The server itself: keys, deadlines, health, reflection, and how it starts and stops."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import grpc
import httpx
import pytest
from grpc_health.v1 import health_pb2, health_pb2_grpc
from grpc_reflection.v1alpha.proto_reflection_descriptor_database import (
    ProtoReflectionDescriptorDatabase,
)

from services.gateway.keys import Scope, add_key
from services.grpc import probe
from services.grpc.app import beside, serving
from services.grpc.client import connect, error_of
from services.grpc.generated import sparge_pb2 as pb
from services.grpc.settings import GrpcSettings
from shared.errors import InvalidInput, StageUnavailable, UnknownTask
from tests.services.gateway.test_access import gateway
from tests.support.grpc_calls import Through, call, failure, grpc_port, grpc_server
from tests.support.serving import free_ports, in_process
from tests.support.serving import serving as serving_http

Code = grpc.StatusCode
NO_TASKS: dict[str, list[str]] = {"tasks": []}
SERVING = health_pb2.HealthCheckResponse.SERVING
NOT_SERVING = health_pb2.HealthCheckResponse.NOT_SERVING


def answering(seen: list[httpx.Request]) -> Callable[[httpx.Request], httpx.Response]:
    """A gateway that is asked for tasks only, and keeps what it was sent."""

    def answer(request: httpx.Request) -> httpx.Response:
        if request.url.path != "/health/ready":
            seen.append(request)
        return httpx.Response(200, json=NO_TASKS)

    return answer


def test_headers_travel_both_ways() -> None:
    seen: list[httpx.Request] = []
    sent = (
        ("authorization", "Bearer secret"),
        ("x-request-id", "robot-7"),
        ("traceparent", "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"),
        ("cookie", "mine"),
    )
    with grpc_server(httpx.MockTransport(answering(seen))) as channel:
        _, trailers = call(channel, "ListTasks", pb.Nothing(), metadata=sent, timeout=20)
        _, others = call(channel, "ListTasks", pb.Nothing(), metadata=(("x-request-id", "a b"),))
    headers = seen[0].headers
    assert headers["authorization"] == "Bearer secret"
    assert headers["traceparent"].startswith("00-0af")
    assert headers["x-request-id"] == trailers["x-request-id"] == "robot-7"
    assert "cookie" not in headers
    assert 15 < float(headers["x-request-timeout"]) < 21
    assert seen[1].headers["x-request-id"] == others["x-request-id"] != "a b"


def test_a_call_without_a_deadline_leaves_it_to_the_gateway() -> None:
    seen: list[httpx.Request] = []
    with grpc_server(httpx.MockTransport(answering(seen))) as channel:
        call(channel, "ListTasks", pb.Nothing(), timeout=None)
    assert "x-request-timeout" not in seen[0].headers


class Slow(httpx.AsyncBaseTransport):
    """A gateway that takes its time, and knows who left before."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self.asked = threading.Event()
        self.left = threading.Event()

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        if request.url.path != "/health/ready":
            self.asked.set()
            try:
                await asyncio.sleep(self.seconds)
            except asyncio.CancelledError:
                self.left.set()
                raise
        return httpx.Response(200, json=NO_TASKS)


def test_nobody_works_on_after_the_deadline(caplog: pytest.LogCaptureFixture) -> None:
    slow = Slow(60)
    with caplog.at_level(logging.INFO, "sparge.access"), grpc_server(slow) as channel:
        late = failure(channel, "ListTasks", pb.Nothing(), timeout=0.3)
        assert late.code() is Code.DEADLINE_EXCEEDED
        assert slow.left.wait(5)
    assert "grpc ListTasks DEADLINE_EXCEEDED" in caplog.text


def test_a_call_that_is_cancelled_is_given_up(caplog: pytest.LogCaptureFixture) -> None:
    slow = Slow(60)
    with caplog.at_level(logging.INFO, "sparge.access"), grpc_server(slow) as channel:
        multi = channel.unary_unary(
            "/sparge.v1.Sparge/ListTasks", pb.Nothing.SerializeToString, pb.TaskList.FromString
        )
        waiting = multi.future(pb.Nothing())
        assert slow.asked.wait(5)
        waiting.cancel()
        assert slow.left.wait(5)
    assert "grpc ListTasks CANCELLED" in caplog.text


def test_a_gateway_that_takes_too_long_is_told() -> None:
    with grpc_server(Slow(60), timeout_s=0.2) as channel:
        late = failure(channel, "ListTasks", pb.Nothing(), timeout=None)
    assert late.code() is Code.DEADLINE_EXCEEDED
    assert "gateway did not answer" in late.details()


def test_a_deadline_of_the_gateway() -> None:
    envelope = {"code": "deadline_exceeded", "message": "m", "details": {}, "request_id": "7"}
    late = httpx.MockTransport(lambda _: httpx.Response(504, json={"error": envelope}))
    with grpc_server(late) as channel:
        assert failure(channel, "ListTasks", pb.Nothing()).code() is Code.DEADLINE_EXCEEDED


def test_nobody_there() -> None:
    (port,) = free_ports(1)
    with grpc_server(None, url=f"http://127.0.0.1:{port}") as channel:
        down = failure(channel, "ListTasks", pb.Nothing())
    assert down.code() is Code.UNAVAILABLE
    assert dict(down.trailing_metadata())["retry-after"] == "2"
    assert "cannot be reached" in down.details()


@pytest.mark.parametrize(
    "answer",
    [
        httpx.Response(200, json={"tasks": [{"name": "pouring"}]}),
        httpx.Response(200, content=b"<html>", headers={"Content-Type": "text/html"}),
        httpx.Response(404, content=b"no such page"),
        httpx.Response(500, json={"error": "oh"}),
    ],
    ids=["another message", "a web page", "another server", "no envelope"],
)
def test_a_gateway_that_answers_nonsense_cannot_be_used(answer: httpx.Response) -> None:
    with grpc_server(httpx.MockTransport(lambda _: answer)) as channel:
        refused = failure(channel, "ListTasks", pb.Nothing())
    assert refused.code() is Code.UNAVAILABLE


def test_messages_have_a_limit_packed_or_not() -> None:
    seen: list[httpx.Request] = []
    large = pb.GraspRequest(points=pb.PointCloud(float32=bytes(12 * 10**5)))
    with grpc_server(httpx.MockTransport(answering(seen)), max_message_bytes=10**6) as channel:
        for packing in (grpc.Compression.NoCompression, grpc.Compression.Gzip):
            refused = failure(channel, "Grasp", large, compression=packing)
            assert refused.code() is Code.RESOURCE_EXHAUSTED
    assert not seen


def test_keys_scopes_and_rates(tmp_path: Path) -> None:
    keys = tmp_path / "keys.json"
    reader = add_key(keys, "reader", (Scope.READ,))
    hasty = add_key(keys, "hasty", (Scope.READ,), rate_per_s=0.01)

    def bearer(key: str) -> dict[str, tuple[tuple[str, str], ...]]:
        return {"metadata": (("authorization", f"Bearer {key}"),)}

    with (
        in_process(gateway(api_keys_file=keys, rate_burst=1)) as http,
        grpc_server(Through(http), health_s=0.05) as channel,
    ):
        assert failure(channel, "ListTasks", pb.Nothing()).code() is Code.UNAUTHENTICATED
        assert not call(channel, "ListTasks", pb.Nothing(), **bearer(reader))[0].tasks
        by_header = {"metadata": (("x-api-key", reader),)}
        assert not call(channel, "ListTasks", pb.Nothing(), **by_header)[0].tasks
        named = pb.TaskName(name="pouring")
        refused = failure(channel, "DeleteTask", named, **bearer(reader))
        assert refused.code() is Code.PERMISSION_DENIED
        call(channel, "ListTasks", pb.Nothing(), **bearer(hasty))
        too_often = failure(channel, "ListTasks", pb.Nothing(), **bearer(hasty))
        assert too_often.code() is Code.RESOURCE_EXHAUSTED
        trailers = dict(too_often.trailing_metadata())
        assert 1 <= int(trailers["retry-after"]) <= 100
        assert int(trailers["grpc-retry-pushback-ms"]) == 1000 * int(trailers["retry-after"])
        assert wait_for(channel, SERVING), "health needs no key"


def wait_for(channel: grpc.Channel, wanted: int, service: str = "") -> bool:
    """Tell whether the health becomes what is wanted, in time."""
    stub = health_pb2_grpc.HealthStub(channel)
    watched = stub.Watch(health_pb2.HealthCheckRequest(service=service), timeout=10)
    with contextlib.suppress(grpc.RpcError):
        return any(said.status == wanted for said in watched)
    return False


def test_health_follows_the_gateway() -> None:
    ready = threading.Event()
    gateway = httpx.MockTransport(lambda _: httpx.Response(200 if ready.is_set() else 503))
    with grpc_server(gateway, health_s=0.02) as channel:
        stub = health_pb2_grpc.HealthStub(channel)
        asked = health_pb2.HealthCheckRequest(service="sparge.v1.Sparge")
        assert stub.Check(asked).status == NOT_SERVING
        ready.set()
        assert wait_for(channel, SERVING)
        assert stub.Check(asked).status == SERVING
        ready.clear()
        assert wait_for(channel, NOT_SERVING, "sparge.v1.Sparge")
        with pytest.raises(grpc.RpcError) as unknown:
            stub.Check(health_pb2.HealthCheckRequest(service="sparge.v2.Sparge"))
        assert unknown.value.code() is Code.NOT_FOUND


def test_reflection_describes_the_service() -> None:
    with grpc_server(httpx.MockTransport(answering([]))) as channel:
        described = ProtoReflectionDescriptorDatabase(channel)
        names = set(described.get_services())
        assert {"sparge.v1.Sparge", "grpc.health.v1.Health"} <= names
        file = described.FindFileContainingSymbol("sparge.v1.Sparge")
    assert file.name == "sparge.proto"
    assert {each.name for each in file.service[0].method} >= {"Grasp", "Explain", "Execute"}


def test_an_unknown_call() -> None:
    with grpc_server(httpx.MockTransport(answering([]))) as channel:
        unknown: grpc.UnaryUnaryMultiCallable[bytes, bytes] = channel.unary_unary(
            "/sparge.v1.Sparge/Juggle"
        )
        with pytest.raises(grpc.RpcError) as caught:
            unknown(b"")
        assert caught.value.code() is Code.UNIMPLEMENTED


@contextlib.contextmanager
def asked_and_stopped(slow: Slow, stop_s: float) -> Iterator[grpc.Future[pb.TaskList]]:
    """A call that was open when its server was told to stop; the server has stopped afterwards."""
    serving = grpc_port(slow, stop_s=stop_s)
    with grpc.insecure_channel(f"127.0.0.1:{serving.__enter__()}") as channel:
        multi = channel.unary_unary(
            "/sparge.v1.Sparge/ListTasks", pb.Nothing.SerializeToString, pb.TaskList.FromString
        )
        future = multi.future(pb.Nothing(), timeout=30)
        assert slow.asked.wait(5)
        stopping = threading.Thread(target=serving.__exit__, args=(None, None, None))
        stopping.start()
        yield future
        stopping.join(10)
        assert not stopping.is_alive()


def test_what_is_open_ends_when_it_stops() -> None:
    started = time.monotonic()
    with asked_and_stopped(Slow(0.5), stop_s=20) as open_call:
        assert not open_call.result(timeout=10).tasks
    assert time.monotonic() - started < 15, "it does not wait any longer"


def test_what_takes_too_long_is_cut_off_when_it_stops() -> None:
    slow = Slow(60)
    with asked_and_stopped(slow, stop_s=0.2) as open_call, pytest.raises(grpc.RpcError):
        open_call.result(timeout=10)
    assert slow.left.wait(5)


async def start(host: str, transport: httpx.AsyncBaseTransport | None, port: int = 0) -> None:
    async with serving(GrpcSettings(), host, port, transport):
        pass


def told(status: int) -> httpx.MockTransport:
    envelope = {"code": "unauthorized", "message": "m", "details": {}, "request_id": "7"}
    return httpx.MockTransport(lambda _: httpx.Response(status, json={"error": envelope}))


def test_other_machines_are_served_only_where_the_gateway_wants_keys() -> None:
    elsewhere = "192.0.2.7"  # no address of any machine: who may listen there cannot
    with pytest.raises(InvalidInput, match="wants no API keys"):
        asyncio.run(start(elsewhere, httpx.MockTransport(answering([]))))
    with pytest.raises(InvalidInput, match="cannot listen"):
        asyncio.run(start(elsewhere, told(401)))
    with pytest.raises(StageUnavailable):
        asyncio.run(start(elsewhere, told(503)))
    (port,) = free_ports(1)
    asyncio.run(start("127.0.0.1", httpx.MockTransport(answering([])), port))


def test_beside_the_http_interface() -> None:
    (port,) = free_ports(1)
    both = beside(gateway(), GrpcSettings(health_s=0.02), "127.0.0.1", port)
    with serving_http(both) as url, connect(f"127.0.0.1:{port}") as sparge:
        assert httpx.get(f"{url}/tasks").json() == NO_TASKS
        assert not sparge.ListTasks(pb.Nothing(), timeout=20).tasks
        with grpc.insecure_channel(f"127.0.0.1:{port}") as channel:
            assert wait_for(channel, SERVING)
    assert not probe.serving(f"127.0.0.1:{port}"), "both have stopped"


def test_a_call_is_one_line_of_the_log(caplog: pytest.LogCaptureFixture) -> None:
    refused = {"code": "unknown_task", "message": "m", "details": {}, "request_id": "7"}
    answers = httpx.MockTransport(lambda _: httpx.Response(422, json={"error": refused}))
    with caplog.at_level(logging.INFO, "sparge.access"), grpc_server(answers) as channel:
        failure(channel, "Grasp", pb.GraspRequest(), metadata=(("authorization", "secret"),))
    (line,) = [each for each in caplog.records if each.name == "sparge.access"]
    assert line.getMessage().startswith("grpc Grasp INVALID_ARGUMENT in ")
    assert (vars(line)["status"], vars(line)["code"]) == ("INVALID_ARGUMENT", "unknown_task")
    assert "secret" not in str(vars(line))


def test_an_address_that_is_taken() -> None:
    (port,) = free_ports(1)

    async def twice() -> None:
        async with serving(GrpcSettings(), "127.0.0.1", port, told(503)):
            await start("127.0.0.1", told(503), port)

    with pytest.raises(InvalidInput, match=f"cannot listen on 127.0.0.1:{port}"):
        asyncio.run(twice())


def test_a_server_without_a_gateway() -> None:
    with pytest.raises(ValueError, match="SPARGE_GRPC_URL"):
        asyncio.run(start("127.0.0.1", None))


def test_the_client_that_comes_along() -> None:
    envelope = {
        "code": "unknown_task",
        "message": "no such task",
        "details": {"known": ["pouring"]},
        "request_id": "7",
    }

    def answer(request: httpx.Request) -> httpx.Response:
        if request.method == "POST":
            return httpx.Response(422, json={"error": envelope})
        return httpx.Response(200, json=NO_TASKS)

    with grpc_port(httpx.MockTransport(answer)) as port, connect(f"127.0.0.1:{port}") as sparge:
        assert not sparge.ListTasks(pb.Nothing()).tasks
        with pytest.raises(grpc.RpcError) as refused:
            sparge.Grasp(pb.GraspRequest(task="juggling"))
    (nobody,) = free_ports(1)
    with connect(f"127.0.0.1:{nobody}") as sparge, pytest.raises(grpc.RpcError) as gone:
        sparge.ListTasks(pb.Nothing(), timeout=20)
    error = error_of(refused.value)
    assert isinstance(error, UnknownTask)
    assert (error.message, error.details) == ("no such task", {"known": ["pouring"]})
    assert error_of(gone.value) is None


def test_the_probe_of_the_image() -> None:
    with grpc_port(told(503)) as port:
        assert not probe.serving(f"127.0.0.1:{port}")
    with grpc_port(httpx.MockTransport(answering([])), health_s=0.02) as port:
        deadline = time.monotonic() + 5
        while not probe.serving(f"127.0.0.1:{port}"):
            assert time.monotonic() < deadline
    assert not probe.serving(f"127.0.0.1:{port}"), "nobody is there any more"
