"""The page's server: a session for every browser that comes."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import viser

from services.viewer.session import Session
from services.viewer.sources import Sources
from shared.client import Sparge


@contextlib.contextmanager
def serving(sparge: Sparge, sources: Sources, host: str, port: int) -> Iterator[str]:
    """Serve the page until left; yields its URL.

    Parameters
    ----------
    sparge : Sparge
        The backend.
    sources : Sources
        What can be looked at.
    host : str
        Address to listen on. Everybody who reaches it can ask, teach and upload: there are no keys.
    port : int
        The next free one is taken where it is not free.
    """
    server = viser.ViserServer(host=host, port=port, label="SPaRGE", verbose=False)
    sessions: dict[int, Session] = {}
    server.gui.configure_theme(
        control_width="large", show_logo=False, show_share_button=False, brand_color=(0, 114, 178)
    )
    server.scene.configure_default_lights(cast_shadow=False)  # half the work of a page without GPU

    @server.on_client_connect
    def _(client: viser.ClientHandle) -> None:
        sessions[client.client_id] = Session(client, sparge, sources.copy())

    @server.on_client_disconnect
    def _(client: viser.ClientHandle) -> None:
        session = sessions.pop(client.client_id, None)
        if session is not None:
            session.close()

    try:
        yield f"http://{server.get_host()}:{server.get_port()}"
    finally:
        for session in list(sessions.values()):
            session.close()
        server.stop()
