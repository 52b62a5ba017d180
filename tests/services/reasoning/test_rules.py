"""The Prolog files' own tests, run by SWI-Prolog, and that a broken file cannot pass."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from shared.settings import PROJECT_ROOT

RULES = PROJECT_ROOT / "rules"
SWIPL = ["swipl", "--on-error=status", "--on-warning=status", "-g", "run_tests", "-t", "halt"]
TESTS = sorted(RULES.rglob("*.plt"))


def run(file: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*SWIPL, str(file)],
        capture_output=True,
        text=True,
        timeout=60,
        stdin=subprocess.DEVNULL,
        cwd=file.parent,
    )


@pytest.mark.parametrize("file", TESTS, ids=[str(file.relative_to(RULES)) for file in TESTS])
def test_prolog_tests_pass(file: Path) -> None:
    result = run(file)
    assert result.returncode == 0, result.stderr
    assert "tests passed" in result.stderr


def test_every_rule_file_has_tests() -> None:
    engine_room = {"loader"}  # tested with rule_sets
    files = {file.with_suffix("") for file in RULES.rglob("*.pl") if file.stem not in engine_room}
    assert files == {file.with_suffix("") for file in TESTS}


@pytest.mark.parametrize(
    "text",
    [
        "test(broken) :- .\n",
        "test(wrong) :- fail.\n",
        "test(unknown) :- no_such_predicate(1).\n",
        "test(singleton) :- X = 1.\n",
    ],
)
def test_a_broken_file_fails(tmp_path: Path, text: str) -> None:
    file = tmp_path / "broken.plt"
    file.write_text(
        ":- use_module(library(plunit)).\n:- begin_tests(broken).\ntest(fine).\n"
        f"{text}:- end_tests(broken).\n"
    )
    assert run(file).returncode != 0
