"""Prolog inside the process: one owner thread, no leaks, no noise, clear complaints."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from services.reasoning.prolog import prolog
from services.reasoning.reasoner import Reasoner
from shared.errors import InternalError
from shared.schemas.task import DecideRequest, Version
from shared.settings import PROJECT_ROOT
from tests.services.reasoning.objects import BOTTLE, HAMMER, KNIFE, LADLE, PAN, TURNER

RULES = PROJECT_ROOT / "rules"


def run(code: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-W", "error", "-c", code, *arguments],
        capture_output=True,
        text=True,
        timeout=60,
        cwd=PROJECT_ROOT,
        env={**os.environ, "PYTHONPATH": str(PROJECT_ROOT)},
    )


WARM_UP = """
import sys
from pathlib import Path
from services.reasoning.reasoner import Reasoner
from services.reasoning.settings import ReasoningSettings
reasoner = Reasoner(ReasoningSettings(rules_dir=Path(sys.argv[1])))
try:
    reasoner.warm_up()
except Exception as error:
    sys.exit(f"{type(error).__name__}: {error}")
"""


def broken_rules(folder: Path, file: str, text: str) -> str:
    copy = folder / "rules"
    shutil.copytree(RULES, copy)
    with (copy / file).open("a") as stream:
        stream.write(text)
    return run(WARM_UP, str(copy)).stderr


def test_a_process_with_prolog_starts_works_and_ends_silently() -> None:
    result = run(WARM_UP, str(RULES))
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")


def test_exit_codes_are_left_alone() -> None:
    result = run(WARM_UP + "sys.exit('gone')", str(RULES))
    assert (result.returncode, result.stdout, result.stderr) == (1, "", "gone\n")


@pytest.mark.parametrize("file", ["thesis/version1.pl", "predicates.pl"])
def test_a_syntax_error_in_a_rule_file_stops_the_start(tmp_path: Path, file: str) -> None:
    said = broken_rules(tmp_path, file, "\naffordTask(ID, dancing) :- max_shape(ID.\n")
    assert said.startswith("InternalError")
    assert file in said
    assert "yntax error" in said


def test_a_rule_that_calls_an_unknown_predicate_stops_the_start(tmp_path: Path) -> None:
    text = "\naffordTask(ID, dancing) :- primitive_values(ID, _, _), light(ID).\n"
    said = broken_rules(tmp_path, "thesis/version1.pl", text)
    assert "calls light/1, which is not known" in said


def test_a_rule_with_an_impossible_bound_stops_the_start(tmp_path: Path) -> None:
    text = "\npartAffordance(ID, cut) :- primitive_values(ID, D, _), min_dimension(D, [1, 2]).\n"
    said = broken_rules(tmp_path, "thesis/version2.pl", text)
    assert "three numbers" in said


def test_an_affordance_without_a_rule_stops_the_start(tmp_path: Path) -> None:
    text = "\npartAffordance(ID, fly) :- primitive_values(ID, _, _).\n"
    said = broken_rules(tmp_path, "thesis/version2.pl", text)
    assert "do not agree on fly" in said


def test_missing_rules_stop_the_start(tmp_path: Path) -> None:
    said = run(WARM_UP, str(tmp_path)).stderr
    assert said.startswith("InternalError")
    assert "Traceback" not in said


def test_without_swi_prolog_the_start_says_what_to_install() -> None:
    said = run("import sys; sys.modules['pyswip'] = None\n" + WARM_UP, str(RULES)).stderr
    assert said.startswith("StageUnavailable")
    assert "apt-get install swi-prolog-nox" in said


def test_one_process_has_one_set_of_rules(reasoner: Reasoner, tmp_path: Path) -> None:
    with pytest.raises(InternalError, match="cannot load"):
        prolog(tmp_path)


def test_an_error_in_prolog_is_an_error_of_ours(reasoner: Reasoner) -> None:
    engine = prolog(RULES)
    with pytest.raises(InternalError, match="could not decide"):
        engine.ask("decide")
    with pytest.raises(InternalError, match="could not dance"):
        engine.ask("dance")


def test_sixteen_at_once_get_their_own_answers(
    reasoner: Reasoner, capfd: pytest.CaptureFixture[str]
) -> None:
    versions: tuple[Version, ...] = ("v1", "v2")
    tasks = ("cooking", "pouring", "handover", "turning")
    requests = [
        DecideRequest(task=task, reasoning=version, primitives=primitives)
        for primitives in (PAN, BOTTLE, HAMMER, LADLE, TURNER, KNIFE, ())
        for task in tasks
        for version in versions
    ]
    alone = [reasoner.decide(request) for request in requests]
    with ThreadPoolExecutor(16) as pool:
        for together in [list(pool.map(reasoner.decide, requests)) for _ in range(4)]:
            assert together == alone
    assert capfd.readouterr() == ("", "")
