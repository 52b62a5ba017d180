from __future__ import annotations

import json
import logging
import stat
from pathlib import Path

import pytest

from services.gateway.keys import PREFIX, Keyring, Scope, add_key, delete_key, read_keys
from shared.errors import Conflict, InvalidInput, NotFound


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "secrets" / "keys.json"


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        self.now += 2.0  # past the pause between two looks at the file
        return self.now


def test_only_the_hash_is_kept_for_the_owner_alone(path: Path) -> None:
    text = add_key(path, "robot", (Scope.GRASP,))
    assert text.startswith(PREFIX)
    assert text not in path.read_text()
    assert text.removeprefix(PREFIX) not in path.read_text()
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert list(path.parent.iterdir()) == [path]


def test_a_key_is_found_by_its_text_alone(path: Path) -> None:
    first, second = (add_key(path, name, (Scope.READ,)) for name in ("first", "second"))
    ring = Keyring(path)
    found = ring.find(first), ring.find(second)
    assert [key and key.name for key in found] == ["first", "second"]
    for wrong in ("", first[:-1], first + "x", first.upper(), read_keys(path).keys[0].sha256):
        assert ring.find(wrong) is None


def test_scopes_open_what_they_say_and_admin_everything(path: Path) -> None:
    add_key(path, "robot", (Scope.READ, Scope.GRASP))
    add_key(path, "root", (Scope.ADMIN,))
    robot, root = read_keys(path).keys
    assert [robot.may(scope) for scope in Scope] == [True, True, False, False]
    assert all(root.may(scope) for scope in Scope)


def test_keys_are_exchanged_without_a_restart(path: Path) -> None:
    old = add_key(path, "old", (Scope.READ,))
    ring = Keyring(path, Clock())
    new = add_key(path, "new", (Scope.READ,))
    assert ring.find(old)
    assert ring.find(new)
    delete_key(path, "old")
    assert ring.find(old) is None
    assert ring.find(new)


@pytest.mark.parametrize("damage", ["", "{", '{"keys": [{"name": "x"}]}', None])
def test_a_damaged_file_changes_nothing_and_is_told(
    path: Path, damage: str | None, caplog: pytest.LogCaptureFixture
) -> None:
    text = add_key(path, "robot", (Scope.READ,))
    ring = Keyring(path, Clock())
    if damage is None:
        path.unlink()
    else:
        path.write_text(damage)
    with caplog.at_level(logging.ERROR):
        assert ring.find(text)
    assert "stay as they were" in caplog.text
    with pytest.raises(InvalidInput, match=r"keys\.json"):
        Keyring(path)


def test_names_are_taken_once_and_known_when_deleted(path: Path) -> None:
    add_key(path, "robot", (Scope.READ,))
    before = path.read_bytes()
    with pytest.raises(Conflict, match="robot"):
        add_key(path, "robot", (Scope.READ,))
    with pytest.raises(NotFound, match="known are: robot"):
        delete_key(path, "arm")
    for name, rate in (("Robot 7", None), ("slow", -1.0)):
        with pytest.raises(InvalidInput, match=r"name|rate_per_s"):
            add_key(path, name, (Scope.READ,), rate)
    assert path.read_bytes() == before


def test_what_is_not_a_keyfile_is_not_overwritten(path: Path) -> None:
    path.parent.mkdir()
    path.write_text(json.dumps({"other": 1}))
    with pytest.raises(InvalidInput, match="not valid"):
        add_key(path, "robot", (Scope.READ,))
    assert json.loads(path.read_text()) == {"other": 1}
