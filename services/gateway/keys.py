"""API keys: who may ask what, kept as hashes in a file that may change while the gateway runs.

A key is 256 random bits, so its SHA-256 cannot be guessed back and needs no salt or slow hash,
which exist for passwords that people choose.
"""

from __future__ import annotations

import hashlib
import hmac
import logging
import os
import secrets
import tempfile
import time
from collections.abc import Callable
from datetime import UTC, datetime
from enum import StrEnum
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from shared.errors import Conflict, InvalidInput, NotFound

PREFIX = "sparge_"
_LOOK_EVERY_S = 1.0

log = logging.getLogger("sparge")


class Scope(StrEnum):
    """What a key opens."""

    READ = "read"
    """Everything that is only looked at."""
    GRASP = "grasp"
    """POST /grasp and POST /execute."""
    KNOWLEDGE = "knowledge"
    """Teaching and forgetting."""
    ADMIN = "admin"
    """All of it."""


class ApiKey(BaseModel):
    """One key, without the key itself."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: Annotated[str, Field(pattern=r"^[a-z][a-z0-9_-]{0,63}$")]
    sha256: Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
    scopes: Annotated[tuple[Scope, ...], Field(min_length=1)]
    rate_per_s: Annotated[float, Field(gt=0)] | None = None
    """Requests a second, in the long run; None: the gateway's own limit."""
    created: datetime

    def may(self, scope: Scope) -> bool:
        """Tell whether the key opens what needs `scope`."""
        return scope in self.scopes or Scope.ADMIN in self.scopes


class KeyFile(BaseModel):
    """What the file holds, as JSON."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    keys: tuple[ApiKey, ...] = ()


def read_keys(path: Path) -> KeyFile:
    """Return what the file holds.

    Raises
    ------
    InvalidInput
        It is not there, cannot be read or is not valid.
    """
    try:
        return KeyFile.model_validate_json(path.read_bytes())
    except OSError as error:
        raise InvalidInput(f"the API keys in {path} cannot be read: {error.strerror}") from None
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or "the file"
        raise InvalidInput(
            f"the API keys in {path} are not valid: {where}: {first['msg']}"
        ) from None


def add_key(
    path: Path, name: str, scopes: tuple[Scope, ...], rate_per_s: float | None = None
) -> str:
    """Make a key, put its hash into the file and return it: it is not to be had again.

    Raises
    ------
    Conflict
        There is one of this name.
    InvalidInput
        The file, the name or the rate is not valid.
    """
    held = read_keys(path) if path.exists() else KeyFile()
    if any(key.name == name for key in held.keys):
        raise Conflict(f"there is a key named {name!r}; delete it first, or choose another name")
    text = PREFIX + secrets.token_urlsafe(32)
    try:
        key = ApiKey(
            name=name,
            sha256=_digest(text),
            scopes=scopes,
            rate_per_s=rate_per_s,
            created=datetime.now(UTC).replace(microsecond=0),
        )
    except ValidationError as error:
        first = error.errors()[0]
        field = ".".join(map(str, first["loc"]))
        raise InvalidInput(f"{field}: {first['msg']}", field=field) from None
    _write(path, KeyFile(keys=(*held.keys, key)))
    return text


def delete_key(path: Path, name: str) -> None:
    """Take a key out of the file; a running gateway forgets it within a second.

    Raises
    ------
    NotFound
        There is none of this name.
    InvalidInput
        The file is not valid.
    """
    held = read_keys(path)
    kept = tuple(key for key in held.keys if key.name != name)
    if len(kept) == len(held.keys):
        known = ", ".join(key.name for key in held.keys) or "none"
        raise NotFound(f"there is no key named {name!r}; known are: {known}")
    _write(path, KeyFile(keys=kept))


class Keyring:
    """The keys of a file, read again when it changes.

    A change that cannot be read leaves the keys as they were, and is logged: a broken or
    missing file neither opens nor closes a running gateway.

    Parameters
    ----------
    path : Path
    clock : callable, optional
        Seconds since some fixed time.

    Raises
    ------
    InvalidInput
        The file cannot be read now.
    """

    def __init__(self, path: Path, clock: Callable[[], float] = time.monotonic) -> None:
        self._path, self._clock = path, clock
        self._seen = self._stamp()
        self._keys = read_keys(path).keys
        self._looked = clock()

    def find(self, text: str) -> ApiKey | None:
        """Return the key that `text` is; compared with all, each in constant time."""
        self._look()
        given = _digest(text)
        found = None
        for key in self._keys:
            if hmac.compare_digest(key.sha256, given):
                found = key
        return found

    def _look(self) -> None:
        if self._clock() - self._looked < _LOOK_EVERY_S:
            return
        self._looked = self._clock()
        stamp = self._stamp()
        if stamp == self._seen:
            return
        self._seen = stamp
        try:
            self._keys = read_keys(self._path).keys
        except InvalidInput as error:
            log.error("the API keys stay as they were: %s", error.message)

    def _stamp(self) -> tuple[int, int, int] | None:
        try:
            stat = self._path.stat()
        except OSError:
            return None
        return stat.st_ino, stat.st_mtime_ns, stat.st_size


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _write(path: Path, keys: KeyFile) -> None:
    """Replace the file whole, for its owner's eyes only."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "w") as file:
            file.write(keys.model_dump_json(indent=1) + "\n")
            file.flush()
            os.fsync(file.fileno())
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
