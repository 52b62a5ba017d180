"""`sparge doctor` on installations and backends that are broken in known ways."""

from __future__ import annotations

import json
import os
import re
import socket
import subprocess
import sys
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI

from services.cli.doctor import environment, knowledge, remote, system
from services.cli.doctor.finding import Finding, Status, worst
from services.cli.doctor.packages import EXTRAS, OPTIONAL, extra_of
from services.cli.doctor.probe import probe
from services.gateway.settings import STAGES
from services.matching.app import create_app
from tests.support.serving import free_ports, serving

ROOT = Path(__file__).parents[3]
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def only(findings: Iterable[Finding]) -> Finding:
    (found,) = findings
    return found


def failed(findings: Iterable[Finding]) -> Finding:
    """Return the one finding that is a failure; it says what to do."""
    (found,) = [each for each in findings if each.status is Status.fail]
    assert found.advice
    return found


def sparge_doctor(variables: dict[str, str], *words: str) -> tuple[int, dict[str, Any]]:
    done = subprocess.run(
        [*(sys.executable, "-c", "from services.cli import main; main()"), "doctor", *words],
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
        timeout=300,
        cwd=ROOT,
    )
    assert "Traceback" not in done.stderr
    report: dict[str, Any] = json.loads(done.stdout)
    return done.returncode, report


@pytest.mark.slow
def test_a_sound_installation_answers_a_question(tmp_path: Path) -> None:
    variables = {"SPARGE_REASONING_KNOWLEDGE_DIR": str(tmp_path / "knowledge")}
    (port,) = free_ports(1)
    code, report = sparge_doctor(variables, "--json", "--port", str(port))
    broken = [each for each in report["findings"] if each["status"] == "fail"]
    assert (code, broken) == (0, [])
    found = {each["check"]: each for each in report["findings"]}
    assert "3 grasps for pouring" in found["question"]["message"]
    assert "SWI-Prolog" in found["pyswip"]["message"]
    assert "shape_classifier.onnx sha256 " in found["shape classifier"]["message"]
    assert {f"extra {extra_of(each)}" for each in (*STAGES, *OPTIONAL)} <= set(found)
    assert not (tmp_path / "knowledge").exists(), "it only looks"


@pytest.mark.slow
def test_everything_that_is_broken_is_told_at_once(tmp_path: Path) -> None:
    (nobody,) = free_ports(1)
    blocked = tmp_path / "file"
    blocked.touch()
    no_prolog = tmp_path / "no_prolog"
    no_prolog.mkdir()
    (no_prolog / "pyswip.py").write_text("raise ImportError('SWI-Prolog library not found')")
    with socket.create_server(("127.0.0.1", 0)) as taken:
        code, report = sparge_doctor(
            {
                "PATH": str(tmp_path),
                "PYTHONPATH": os.pathsep.join([str(no_prolog), *filter(None, sys.path)]),
                "SPARGE_REASONING_KNOWLEDGE_DIR": str(blocked / "knowledge"),
                "SPARGE_GATEWAY_DEADLINE": "3",
                **{
                    f"SPARGE_GATEWAY_{each.upper()}_URL": f"http://127.0.0.1:{nobody}"
                    for each in STAGES
                    if each != "reasoning"
                },
            },
            *("--json", "--port", str(taken.getsockname()[1])),
        )
    assert (code, report["status"]) == (1, "fail")
    broken = {each["check"]: each for each in report["findings"] if each["status"] == "fail"}
    assert all(each["advice"] for each in broken.values())
    asked = {each for each in STAGES if each != "reasoning"}
    assert set(broken) >= {"configuration", "port", "pyswip", "swi-prolog", "knowledge folder"}
    assert set(broken) >= asked
    assert broken["configuration"]["advice"] == "meant is SPARGE_GATEWAY_DEADLINE_S?"
    assert report["findings"][-1]["status"] == "skip", "no question is asked"


def test_typing_errors_and_wrong_values(monkeypatch: pytest.MonkeyPatch) -> None:
    typo = failed(environment.configuration({"SPARGE_GATWAY_SAMPLES": "100"}))
    assert typo.message == "nothing reads SPARGE_GATWAY_SAMPLES"
    assert typo.advice == "meant is SPARGE_GATEWAY_SAMPLES?"
    own = only(environment.configuration({"SPARGE_MY_OWN_NOTE": "x"}))
    assert own.status is Status.warn
    monkeypatch.setenv("SPARGE_GATEWAY_SAMPLES", "many")
    wrong = failed(environment.configuration())
    assert wrong.message.startswith("SPARGE_GATEWAY_SAMPLES='many': Input should be a valid int")
    monkeypatch.delenv("SPARGE_GATEWAY_SAMPLES")
    monkeypatch.setenv("SPARGE_LOG_FORMAT", "xml")
    assert "SPARGE_LOG_FORMAT='xml'" in failed(environment.configuration()).message


def test_every_setting_is_known() -> None:
    classes = environment.settings_classes()
    assert set(classes) == {*STAGES, "gateway", "grpc", "log"}
    names = {name for each in classes.values() for name in environment.variables(each).values()}
    assert {
        "SPARGE_GRIPPERS_DIR",
        "SPARGE_LOG_LEVEL",
        "SPARGE_GATEWAY_PERCEPTION_URL",
        "SPARGE_EXECUTION_WORKERS",
        "SPARGE_MATCHING_MAX_BODY_BYTES",
    } <= names
    assert only(environment.configuration(dict.fromkeys(names, ""))).status is Status.ok


def test_the_users_own_grippers_are_read(tmp_path: Path) -> None:
    (tmp_path / "hook.toml").write_text("kind = 'hook'")
    assert (
        "hook.toml"
        in failed(environment.configuration({"SPARGE_GRIPPERS_DIR": str(tmp_path)})).message
    )


def test_swipl_is_sought_in_the_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert only(knowledge.swipl(Status.fail)).status is Status.ok
    monkeypatch.setenv("PATH", str(tmp_path))
    assert only(knowledge.swipl(Status.warn)).status is Status.warn
    assert "apt-get install swi-prolog-nox" in failed(knowledge.swipl(Status.fail)).advice
    broken = tmp_path / "swipl"
    broken.write_text("#!/bin/sh\necho no home >&2\nexit 2\n")
    broken.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin")
    assert "no home" in failed(knowledge.swipl(Status.fail)).message


def test_a_knowledge_folder_that_cannot_be_written(tmp_path: Path) -> None:
    assert only(knowledge.folder(tmp_path / "new" / "folder")).status is Status.ok
    assert list(tmp_path.iterdir()) == []
    blocked = tmp_path / "file"
    blocked.touch()
    assert "SPARGE_REASONING_KNOWLEDGE_DIR" in failed(knowledge.folder(blocked / "sub")).advice


def test_a_damaged_journal(tmp_path: Path) -> None:
    assert only(knowledge.journal(tmp_path)).message == "0 records"
    (tmp_path / "knowledge.journal").write_text("sparge knowledge 1\nbad line\nbad line\n")
    assert "record 1 is damaged" in failed(knowledge.journal(tmp_path)).message


def test_a_crash_is_a_finding(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "pyswip.py").write_text("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    monkeypatch.syspath_prepend(str(tmp_path))
    found = failed(probe("pyswip"))
    assert found.check == "pyswip"
    assert "was ended by SIGSEGV" in found.message


def test_rules_and_an_ontology_that_do_not_load(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "broken.ttl").write_text("this is no Turtle")
    monkeypatch.setenv("SPARGE_REASONING_RULES_DIR", str(tmp_path / "nowhere"))
    monkeypatch.setenv("SPARGE_REASONING_ONTOLOGY_FILE", str(tmp_path / "broken.ttl"))
    found = [*probe("reasoning")]
    assert [(each.check, each.status) for each in found] == [
        ("rules", Status.fail),
        ("ontology", Status.fail),
    ]
    assert "SPARGE_REASONING_RULES_DIR" in found[0].advice
    assert "broken.ttl" in found[1].message


def test_a_missing_package_and_a_hang(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "rdflib.py").write_text("raise ImportError('no rdflib here')")
    monkeypatch.syspath_prepend(str(tmp_path))
    found = [*probe("packages", "reasoning", "matching")]
    assert [each.status for each in found] == [Status.fail, Status.ok]
    assert "no rdflib here" in found[0].message
    assert "sparge[reasoning]" in found[0].advice
    (tmp_path / "rdflib.py").write_text("import time; time.sleep(60)")
    assert "took longer than" in failed(probe("packages", "reasoning", timeout_s=3)).message


def test_the_packages_are_those_of_the_extras() -> None:
    for extra, modules in EXTRAS.items():
        wanted = {re.split(r"[<>=]", each)[0] for each in PYPROJECT["optional-dependencies"][extra]}
        assert set(modules) == wanted - {"pyswip"}, extra
    assert {extra_of(each) for each in (*STAGES, "gateway")} <= set(EXTRAS)


def test_the_python_is_that_of_the_project() -> None:
    assert PYPROJECT["requires-python"] == ">={}.{},<{}.{}".format(
        *system.PYTHON[0], *system.PYTHON[1]
    )
    assert only(system.python()).status is Status.ok
    assert "3.9.1" in failed(system.python((3, 9, 1))).message


def test_little_memory_and_a_clock_that_stands(tmp_path: Path) -> None:
    meminfo = tmp_path / "meminfo"
    meminfo.write_text("MemTotal: 2000000 kB\nMemAvailable: 200000 kB\n")
    assert only(system.memory(meminfo)).status is Status.warn
    assert only(system.memory(tmp_path / "nothing")).status is Status.skip
    assert only(system.clock()).status is Status.ok
    assert "NTP" in failed(system.clock(now=1e9)).advice


def test_a_missing_library(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(system, "_NEEDED", {"libmissing.so.1": ("perception", "libmissing1")})
    assert "apt-get install libmissing1" in failed(system.libraries(["perception"])).advice
    assert worst([*system.libraries(["matching"])]) is not Status.fail


def test_ports() -> None:
    (free,) = free_ports(1)
    assert only(system.port("127.0.0.1", free)).status is Status.ok
    with socket.create_server(("127.0.0.1", 0)) as taken:
        assert "--port" in failed(system.port("127.0.0.1", taken.getsockname()[1])).advice
    with serving(create_app()) as url:
        found = only(system.port("127.0.0.1", int(url.rsplit(":", 1)[1])))
    assert found.status is Status.ok
    assert "the matching of SPaRGE" in found.message


def test_a_stage_that_is_not_there_or_another(monkeypatch: pytest.MonkeyPatch) -> None:
    (nobody,) = free_ports(1)
    gone = failed(remote.service("matching", f"http://127.0.0.1:{nobody}", "THE_URL"))
    assert "cannot be reached" in gone.message
    assert "THE_URL" in gone.advice
    with serving(create_app()) as url:
        assert only(remote.service("matching", url, "THE_URL")).status is Status.ok
        assert (
            "is the service matching"
            in failed(remote.service("perception", url, "THE_URL")).message
        )
        monkeypatch.setattr(remote, "__version__", "99")
        monkeypatch.setattr(remote, "_SKEW_S", -1.0)
        ready, version, clock = remote.service("matching", url, "THE_URL")
    assert (ready.status, version.status, clock.status) == (Status.ok, Status.warn, Status.warn)
    assert "differ by" in clock.message


def test_something_else_under_the_url() -> None:
    with serving(FastAPI()) as url:
        assert "is no service of SPaRGE" in failed(remote.service("matching", url, "URL")).message


def test_a_backend_that_is_not_there() -> None:
    (nobody,) = free_ports(1)
    code, report = sparge_doctor({}, "--json", "--url", f"http://127.0.0.1:{nobody}")
    assert (code, [each["check"] for each in report["findings"]]) == (1, ["gateway"])
