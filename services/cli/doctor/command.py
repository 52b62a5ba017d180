"""`sparge doctor`: runs the checks and shows what they found."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import orjson
import typer
from pydantic import ValidationError
from rich.console import Console

from services.cli.doctor import environment, knowledge, remote, system
from services.cli.doctor.finding import Finding, Status, show, worst
from services.cli.doctor.packages import OPTIONAL, extra_of, installed
from services.cli.doctor.probe import probe
from services.gateway.settings import STAGES, GatewaySettings
from services.reasoning.settings import ReasoningSettings
from shared import __version__
from shared.service import tracing

_QUESTION_S = 900.0


def doctor(
    quick: Annotated[bool, typer.Option("--quick", help="Ask no question in the end")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON only")] = False,
    url: Annotated[
        str | None, typer.Option(help="Check this running backend instead of the installation")
    ] = None,
    host: Annotated[str, typer.Option(help="Where `sparge serve` is to listen")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=1, max=65535)] = 8000,
) -> None:
    """Check this installation, or a running backend, and say what is wrong.

    Ends with status 1 if anything that is needed does not work.
    """
    console = Console()
    found: list[Finding] = []
    for finding in _backend(url, quick) if url else _installation(quick, host, port):
        found.append(finding)
        if not as_json:
            show(finding, console)
    if as_json:
        report = {"status": worst(found), "version": __version__, "findings": found}
        print(orjson.dumps(report, option=orjson.OPT_INDENT_2).decode())
    else:
        counted = {each: sum(f.status is each for f in found) for each in Status}
        console.print(", ".join(f"{count} {each}" for each, count in counted.items() if count))
    if worst(found) is Status.fail:
        raise typer.Exit(1)


def _backend(url: str, quick: bool) -> Iterator[Finding]:
    url = url.rstrip("/")
    statuses = []
    for finding in remote.service("gateway", url, "--url"):
        statuses.append(finding.status)
        yield finding
    if Status.fail in statuses:
        return
    yield from remote.metrics(url)
    if not quick:
        yield from remote.question(url)


def _installation(quick: bool, host: str, port: int) -> Iterator[Finding]:
    found: list[Finding] = []
    for finding in _checks(host, port):
        found.append(finding)
        yield finding
    if quick:
        return
    if worst(found) is Status.fail:
        yield Finding("question", Status.skip, "not asked: repair what failed first")
    else:
        yield from probe("question", timeout_s=_QUESTION_S)


def _checks(host: str, port: int) -> Iterator[Finding]:
    yield from system.python()
    yield from system.memory()
    yield from system.disk()
    yield from system.clock()
    yield from system.port(host, port)
    yield from environment.configuration()
    try:
        gateway, reasoning = GatewaySettings(), ReasoningSettings()
    except ValidationError:  # told above
        yield Finding("stages", Status.skip, "not checked: correct the configuration first")
        return
    urls = {name: stage_url for name in STAGES if (stage_url := gateway.stage_url(name))}
    here = [name for name in STAGES if name not in urls]
    yield from system.libraries(here)
    extras = [extra_of(each) for each in (*here, "gateway")]
    if tracing.configured():
        extras.append("tracing")
    extras += installed(OPTIONAL)
    yield from probe("packages", *extras)
    if "reasoning" in here:
        prolog = [*probe("pyswip")]
        works = worst(prolog) is Status.ok
        yield from knowledge.swipl(Status.warn if works else Status.fail)
        yield from prolog
        yield from knowledge.folder(reasoning.knowledge_dir)
        yield from knowledge.journal(reasoning.knowledge_dir)
        if works:
            yield from probe("reasoning")
    yield from probe("models", *here)
    for name, stage_url in urls.items():
        yield from remote.service(name, stage_url, f"SPARGE_GATEWAY_{name.upper()}_URL")
