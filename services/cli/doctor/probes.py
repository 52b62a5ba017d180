"""What `probe` runs in a process of its own: `python -m services.cli.doctor.probes NAME`.

Every line on the standard output is JSON: what is begun, then what was found.
What libraries print goes to the standard error.
"""

from __future__ import annotations

import hashlib
import importlib
import os
import sys
import time
from collections.abc import Callable, Collection
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import orjson

from services.cli.doctor.finding import Finding, Status
from services.cli.doctor.packages import EXTRAS
from shared.errors import SpargeError

SWI_PROLOG = "on Debian: apt-get install swi-prolog-nox; then reinstall pyswip if it persists"


_WITH_KERNELS = {
    "perception": ("perceive",),
    "primitive_recovery": ("recovery", "ems.hierarchy", "ems.overlap"),
    "grasp_proposal": ("proposer",),
}
"""The modules of each stage whose import brings all of its kernels."""


class Report:
    """Writes lines to what was the standard output when the process began."""

    def __init__(self) -> None:
        self._out = os.fdopen(os.dup(1), "wb", buffering=0)
        os.dup2(2, 1)

    def step(self, check: str, work: Callable[[], str], advice: str) -> bool:
        """Do `work`, which returns what was found; an exception is a failure, with `advice`."""
        self._line({"begun": check})
        try:
            finding = Finding(check, Status.ok, work())
        except Exception as error:
            text = error.message if isinstance(error, SpargeError) else str(error)
            message = f"{type(error).__name__}: {text}"
            finding = Finding(check, Status.fail, message, advice)
        self.say(finding)
        return finding.status is Status.ok

    def say(self, finding: Finding) -> None:
        self._line(asdict(finding))

    def _line(self, content: dict[str, Any]) -> None:
        self._out.write(orjson.dumps(content) + b"\n")


def packages(report: Report, *extras: str) -> None:
    """Import what the extras bring."""
    for extra in extras:

        def import_all(extra: str = extra) -> str:
            return ", ".join(_imported(*each) for each in EXTRAS[extra].items()) or "nothing more"

        report.step(f"extra {extra}", import_all, f"pip install 'sparge[{extra}]', or `make setup`")


def _imported(distribution: str, module: str) -> str:
    importlib.import_module(module)
    try:
        return f"{distribution} {version(distribution)}"
    except PackageNotFoundError:
        return distribution


def pyswip(report: Report) -> None:
    """Ask Prolog something through pyswip; it has one owner thread per process, here this one."""

    def load() -> str:
        import pyswip

        (answer,) = pyswip.Prolog.query("current_prolog_flag(version, Version)")
        return f"pyswip {version('pyswip')} with SWI-Prolog {answer['Version']}"

    report.step("pyswip", load, SWI_PROLOG)


def reasoning(report: Report) -> None:
    """Load the rules, the ontology and what was learned."""
    from services.reasoning.ontology import affordances_in, load_ontology, tasks_in
    from services.reasoning.prolog import prolog
    from services.reasoning.reasoner import Reasoner
    from services.reasoning.settings import ReasoningSettings
    from shared.schemas.route import Nothing

    settings = ReasoningSettings()

    def load_rules() -> str:
        prolog(settings.rules_dir)
        return str(settings.rules_dir)

    def read_ontology() -> str:
        graph = load_ontology(settings.ontology_file)
        tasks, affordances = len(tasks_in(graph)), len(affordances_in(graph))
        return f"{settings.ontology_file}: {tasks} tasks, {affordances} affordances"

    def take_over() -> str:
        reasoner = Reasoner(settings)
        reasoner.warm_up()
        try:
            tasks = reasoner.list_tasks(Nothing()).tasks
        finally:
            reasoner.close()
        learned = sum(not task.builtin for task in tasks)
        return f"rules and ontology agree on {len(tasks)} tasks, {learned} of them learned"

    files = "the installation is damaged, or SPARGE_REASONING_{} names the wrong place"
    loaded = report.step("rules", load_rules, files.format("RULES_DIR"))
    read = report.step("ontology", read_ontology, files.format("ONTOLOGY_FILE"))
    if loaded and read:
        report.step("tasks", take_over, "the message names what does not fit")


def models(report: Report, *stages: str) -> None:
    """Load the networks that are shipped, and look for compiled kernels."""
    advice = "a file of the installation is damaged; install it again"
    if "primitive_recovery" in stages:
        from services.primitive_recovery.classify import MODEL as SHAPES
        from services.primitive_recovery.classify import ShapeClassifier
        from services.primitive_recovery.parts.cutter import Cutter

        def shapes() -> str:
            ShapeClassifier()
            return _sums(SHAPES)

        def cutter() -> str:
            Cutter.load()
            return _sums(*sorted(SHAPES.parent.glob("parts_*.npz")))

        report.step("shape classifier", shapes, advice)
        report.step("judges of cuts", cutter, advice)
    if "grasp_proposal" in stages:
        from services.grasp_proposal.learned import MODEL as GRASPS
        from services.grasp_proposal.learned import LearnedScorer

        def scorer() -> str:
            LearnedScorer()
            return _sums(GRASPS)

        report.step("grasp scorer", scorer, advice)
    if compiled := _WITH_KERNELS.keys() & stages:
        _kernels(report, sorted(compiled))


def _kernels(report: Report, stages: Collection[str]) -> None:
    for stage in stages:
        for name in _WITH_KERNELS[stage]:
            importlib.import_module(f"services.{stage}.{name}")
    from shared.jit import kernels_on_disk

    found = kernels_on_disk()
    cached = sum(each is True for each in found.values())
    message = f"{cached} of {len(found)} are compiled"
    if None in found.values():
        advice = "every start compiles anew, for minutes; set NUMBA_CACHE_DIR to a folder"
        report.say(Finding("kernels", Status.fail, "no folder to keep them can be written", advice))
    elif cached < len(found):
        advice = "the first start compiles the rest, for some minutes"
        report.say(Finding("kernels", Status.warn, message, advice))
    else:
        report.say(Finding("kernels", Status.ok, message))


def question(report: Report) -> None:
    """Answer a question about a bundled view by the backend as it is configured."""
    from services.cli.doctor.question import ask
    from services.wiring import create_app
    from shared.client import Sparge
    from shared.service.local import in_process

    def answer() -> str:
        started = time.perf_counter()
        with in_process(create_app(), ready_timeout_s=600.0) as client:
            ready_s = time.perf_counter() - started
            return f"ready after {ready_s:.1f} s; {ask(Sparge(client.request))}"

    report.step("question", answer, "the message names the stage; what is said above may be why")


def _sums(*files: Path) -> str:
    return ", ".join(
        f"{file.name} sha256 {hashlib.sha256(file.read_bytes()).hexdigest()[:12]}" for file in files
    )


PROBES = {each.__name__: each for each in (packages, pyswip, reasoning, models, question)}

if __name__ == "__main__":
    PROBES[sys.argv[1]](Report(), *sys.argv[2:])
