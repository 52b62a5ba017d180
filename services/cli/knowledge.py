"""The knowledge of a backend: of a running one by URL, or on disk through the reasoning alone."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from shared.client import Sparge, connect
from shared.service.local import in_process

URL_HELP = "Ask this backend; without it the knowledge folder of this machine is used"


@contextlib.contextmanager
def knowledge(url: str | None) -> Iterator[Sparge]:
    """Give what answers the routes of tasks, affordances and rules.

    Without a URL only the reasoning stage is started, on the folder that
    `SPARGE_REASONING_KNOWLEDGE_DIR` names. A backend that runs on the same folder
    sees the change with its next request.
    """
    if url is not None:
        with connect(url) as sparge:
            yield sparge
        return
    from services.wiring import create_stage

    with in_process(create_stage("reasoning")) as client:
        yield Sparge(client.request)
