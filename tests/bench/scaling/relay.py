"""A relay in front of a service, which counts the bytes that pass."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

_CHUNK = 1 << 16
_CLOSING_S = 5.0


@dataclass
class Passed:
    """What has passed so far, HTTP's own lines included.

    Attributes
    ----------
    url : str
        To ask instead of the service's own.
    sent, answered : int
        Bytes to the service and from it.
    connections : int
    """

    url: str
    sent: int = 0
    answered: int = 0
    connections: int = 0


@contextlib.contextmanager
def relays(urls: Mapping[str, str]) -> Iterator[dict[str, Passed]]:
    """Give a relay for each service, in a thread of this process.

    Whoever uses them is to close its connections before this ends.
    """
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever, daemon=True)
    thread.start()
    try:
        started = {
            name: asyncio.run_coroutine_threadsafe(_serve(url), loop).result()
            for name, url in urls.items()
        }
        yield {name: passed for name, (passed, _) in started.items()}
        for _, server in started.values():
            loop.call_soon_threadsafe(server.close)
        asyncio.run_coroutine_threadsafe(_rest(), loop).result()
    finally:
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()


async def _serve(url: str) -> tuple[Passed, asyncio.Server]:
    target = urlsplit(url)
    passed = Passed("")

    async def relay(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        passed.connections += 1
        try:
            there_reader, there_writer = await asyncio.open_connection(target.hostname, target.port)
        except OSError:  # nobody listens there yet: hang up, too
            writer.close()
            return
        await asyncio.gather(
            _pass_on(reader, there_writer, passed, "sent"),
            _pass_on(there_reader, writer, passed, "answered"),
        )

    server = await asyncio.start_server(relay, "127.0.0.1", 0)
    passed.url = "http://{}:{}".format(*server.sockets[0].getsockname())
    return passed, server


async def _pass_on(
    reader: asyncio.StreamReader, writer: asyncio.StreamWriter, passed: Passed, counter: str
) -> None:
    with contextlib.suppress(ConnectionError):
        while data := await reader.read(_CHUNK):
            setattr(passed, counter, getattr(passed, counter) + len(data))
            writer.write(data)
            await writer.drain()
    writer.close()
    with contextlib.suppress(ConnectionError):
        await writer.wait_closed()


async def _rest() -> None:
    """Wait until the connections are closed."""
    others = asyncio.all_tasks() - {asyncio.current_task()}
    if others:
        await asyncio.wait(others, timeout=_CLOSING_S)
