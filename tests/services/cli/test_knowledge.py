"""`sparge task` and `sparge rule`: teaching from the shell."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from services.cli.json_lines import line_for, lines_of
from services.cli.main import app
from shared.errors import Conflict, InvalidInput, NotFound
from shared.settings import PROJECT_ROOT

LESSONS = PROJECT_ROOT / "experiments" / "extension" / "rules"
RULE: dict[str, Any] = {
    "name": "by_ratio",
    "task": "slicing",
    "conditions": [{"condition": "min_ratio", "value": 3}],
}


@pytest.fixture(autouse=True)
def knowledge_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "knowledge"
    monkeypatch.setenv("SPARGE_REASONING_KNOWLEDGE_DIR", str(folder))
    monkeypatch.setenv("COLUMNS", "120")
    return folder


def sparge(*words: str) -> Result:
    return CliRunner().invoke(app, words)


def said(*words: str) -> str:
    result = sparge(*words)
    assert result.exit_code == 0, (result.output, result.exception)
    return result.output


def written(folder: Path, content: object) -> str:
    file = folder / "rule.json"
    file.write_text(content if isinstance(content, str) else json.dumps(content, indent=1))
    return str(file)


def test_the_life_of_a_task() -> None:
    relations = ("--requires", "contain", "--grasp", "grasp", "--avoids", "cut")
    assert "known to reasoning v2" in said("task", "add", "stirring", *relations)
    (line,) = [each for each in said("task", "list").splitlines() if "stirring" in each]
    assert line.replace("│", " ").split() == [
        "stirring",
        "v2",
        "contain",
        "grasp",
        "cut",
        "yes",
    ]
    assert isinstance(sparge("task", "add", "stirring", *relations).exception, Conflict)
    assert "forgotten" in said("task", "delete", "stirring")
    assert isinstance(sparge("task", "delete", "stirring").exception, NotFound)
    assert isinstance(sparge("task", "add", "Stir!", *relations).exception, InvalidInput)


def test_the_life_of_a_rule(tmp_path: Path) -> None:
    file = written(tmp_path, RULE)
    assert "sound; a rule for slicing" in said("rule", "check", file)
    assert "slicing" not in said("task", "list")
    assert "min_ratio(Dim_part, 3.0)" in said("rule", "add", file)
    assert "affordTask(ID_part, slicing) :-" in said("rule", "list")
    assert "slicing" in said("task", "list")
    assert "forgotten" in said("rule", "delete", "by_ratio")
    assert said("rule", "list") == ""
    assert "min_relative_volume" in said("rule", "list", "--words")


def test_an_affordance_with_its_rules(tmp_path: Path) -> None:
    bodies = [{"name": name, "conditions": RULE["conditions"]} for name in ("one", "two")]
    file = written(tmp_path, {"name": "press", "description": "Pressing.", "rules": bodies})
    assert "2 rules for the affordance press" in said("rule", "check", file)
    assert "press: an affordance with 2 rules" in said("rule", "add", file)
    assert "known to reasoning v2" in said("task", "add", "pressing", "--grasp", "press")


@pytest.mark.parametrize("file", sorted(LESSONS.glob("*.json")), ids=lambda file: file.stem)
def test_the_rules_of_the_experiment_are_sound(file: Path) -> None:
    assert "sound; a rule for cutting" in said("rule", "check", str(file))


@pytest.mark.parametrize(
    ("content", "complaints"),
    [
        ('{"name": "x",\n "task": ', [":2: not JSON"]),
        ("[]", [":1: file: "]),
        (RULE | {"name": "No Name"}, [":2: name: "]),
        (RULE | {"affordance": "grasp"}, [":1: file: "]),
        (RULE | {"colour": "red"}, [":10: colour: "]),
        (RULE | {"conditions": []}, [":4: conditions: "]),
        (
            RULE
            | {
                "conditions": [
                    {"condition": "halt"},
                    {"condition": "min_ratio", "value": "much"},
                    {"condition": "min_ratio", "value": 2, "of": ["a", "b"]},
                ]
            },
            [
                ":6: conditions.0.condition: there is no 'halt'",
                ":10: conditions.1.value: min_ratio takes a number",
                ":15: conditions.2.of: min_ratio is about one part",
            ],
        ),
        (
            RULE | {"conditions": [{"condition": "min_ratio", "value": True}]},
            [":7: conditions.0.value: takes a number, three lengths"],
        ),
        (
            RULE
            | {
                "conditions": [
                    {"condition": "min_ratio", "value": 3},
                    {"condition": "max_ratio", "value": 2},
                ]
            },
            [":11: conditions.1.value: no part has a ratio of at least 3 and at most 2"],
        ),
        (
            {
                "name": "press",
                "rules": [{"name": "a", "conditions": [{"condition": "affords", "value": "fly"}]}],
            },
            [":9: rules.0.conditions.0.value: affords asks for 'fly'"],
        ),
    ],
)
def test_check_says_what_is_wrong_and_where(
    tmp_path: Path, content: object, complaints: list[str]
) -> None:
    file = written(tmp_path, content)
    result = sparge("rule", "check", file)
    assert result.exit_code == 1
    lines = result.output.splitlines()
    assert len(lines) == len(complaints)
    for line, complaint in zip(lines, complaints, strict=True):
        assert line.startswith(f"{file}{complaint}"), result.output


def test_a_bad_rule_is_not_taught(tmp_path: Path, knowledge_folder: Path) -> None:
    bad = RULE | {"conditions": [{"condition": "halt"}]}
    assert isinstance(sparge("rule", "add", written(tmp_path, bad)).exception, InvalidInput)
    assert isinstance(sparge("rule", "add", written(tmp_path, "{")).exception, InvalidInput)
    assert not knowledge_folder.exists()


def test_a_file_that_is_no_text(tmp_path: Path) -> None:
    file = tmp_path / "rule.json"
    file.write_bytes(b"\xff\xfe\x00")
    assert isinstance(sparge("rule", "check", str(file)).exception, InvalidInput)


def test_check_reads_prolog(tmp_path: Path) -> None:
    predicates = PROJECT_ROOT / "rules" / "predicates"
    head = f":- module(my_rules, []).\n:- use_module('{predicates}').\n\n"
    good = tmp_path / "good.pl"
    good.write_text(head + "affordTask(ID, baking) :- max_shape(ID).\n")
    assert "rules for baking (line 4)" in said("rule", "check", str(good))
    bad = tmp_path / "bad.pl"
    bad.write_text(head.replace("my_", "your_") + "affordTask(ID, baking) :- max_shape(ID.\n")
    result = sparge("rule", "check", str(bad))
    assert result.exit_code == 1
    assert "bad.pl:4:" in result.output
    assert "yntax error" in result.output


def test_an_error_ends_with_one_line_and_status_1(knowledge_folder: Path) -> None:
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            "from services.cli import main; main()",
            "task",
            "delete",
            "dancing",
        ],
        env={**os.environ, "SPARGE_REASONING_KNOWLEDGE_DIR": str(knowledge_folder)},
        capture_output=True,
        text=True,
        timeout=60,
        cwd=PROJECT_ROOT,
    )
    assert done.returncode == 1
    assert done.stderr.startswith("not_found: there is no task 'dancing'")
    assert "Traceback" not in done.stderr


def test_lines() -> None:
    text = '{"a": [1,\n {"b\\"": "x\\ny"},\n\n {}], "c":\n []}'
    lines = lines_of(text)
    assert lines == {"": 1, "a": 1, "a.0": 1, "a.1": 2, 'a.1.b"': 2, "a.2": 4, "c": 5}
    assert line_for("a.1.value.0", lines) == 2
    assert line_for("elsewhere", lines) == 1
