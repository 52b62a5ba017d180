"""What reasoning needs of the machine: SWI-Prolog, a folder to write to, a journal to read."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

from services.cli.doctor.finding import Finding, Status
from services.reasoning.journal import Journal
from shared.errors import InternalError

SETTING = "SPARGE_REASONING_KNOWLEDGE_DIR"


def swipl(otherwise: Status) -> Iterator[Finding]:
    """Check that SWI-Prolog is there.

    Parameters
    ----------
    otherwise : Status
        If it is not: pyswip asks the program where its library is, but finds it in the
        system's usual places as well.
    """
    advice = "on Debian: apt-get install swi-prolog-nox"
    program = shutil.which("swipl")
    if program is None:
        yield Finding("swi-prolog", otherwise, "no program swipl in the PATH", advice)
        return
    try:
        done = subprocess.run([program, "--version"], capture_output=True, text=True, timeout=10)
        said, works = (done.stdout or done.stderr).strip(), done.returncode == 0
    except (OSError, subprocess.TimeoutExpired) as error:
        said, works = str(error), False
    if works:
        yield Finding("swi-prolog", Status.ok, f"{said} at {program}")
    else:
        yield Finding("swi-prolog", otherwise, f"{program}: {said}", advice)


def folder(path: Path) -> Iterator[Finding]:
    """Check that changes can be stored in a folder, which need not exist yet."""
    existing = next(each for each in (path, *path.absolute().parents) if each.exists())
    try:
        with tempfile.TemporaryFile(dir=existing):
            pass
    except OSError as error:
        message = f"{path} cannot be written ({error.strerror}): nothing can be learned"
        yield Finding("knowledge folder", Status.fail, message, f"set {SETTING} to one that can")
        return
    made = "" if path.exists() else ", made with the first change"
    yield Finding("knowledge folder", Status.ok, f"{path}{made}")


def journal(path: Path) -> Iterator[Finding]:
    """Check that what was learned can be read."""
    held = Journal(path)
    try:
        held.news()
    except (InternalError, OSError) as error:
        message = error.message if isinstance(error, InternalError) else str(error)
        advice = "put a backup of knowledge.journal in its place, or move it away"
        yield Finding("knowledge journal", Status.fail, message, advice)
    else:
        yield Finding("knowledge journal", Status.ok, f"{held.records} records")
    finally:
        held.close()
