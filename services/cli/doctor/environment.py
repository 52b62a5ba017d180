"""The configuration: `SPARGE_*` variables that nobody reads, and values that are not valid."""

from __future__ import annotations

import difflib
import importlib
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from pydantic import ValidationError
from pydantic_settings import BaseSettings

from services.cli.doctor.finding import Finding, Status
from services.gateway.settings import STAGES
from shared.client import API_KEY_VARIABLE
from shared.grippers.library import load_grippers
from shared.service.logs import LogSettings

PREFIX = "SPARGE_"
_ALIKE = 0.8


def settings_classes() -> dict[str, type[BaseSettings]]:
    """Return the settings of every service, and of what all services share, by name."""
    found: dict[str, type[BaseSettings]] = {"log": LogSettings}
    for service in (*STAGES, "gateway", "grpc"):
        module = importlib.import_module(f"services.{service}.settings")
        (found[service],) = (
            value
            for value in vars(module).values()
            if isinstance(value, type)
            and issubclass(value, BaseSettings)
            and value.model_config.get("env_prefix") == f"{PREFIX}{service.upper()}_"
        )
    return found


def variables(settings: type[BaseSettings]) -> dict[str, str]:
    """Return the environment variable of each field, by the field's name in error messages."""
    prefix = settings.model_config.get("env_prefix", "")
    return {
        str(field.validation_alias or name): str(
            field.validation_alias or f"{prefix}{name}".upper()
        )
        for name, field in settings.model_fields.items()
    }


def configuration(environment: Mapping[str, str] = os.environ) -> Iterator[Finding]:
    """Check every variable's name and value."""
    classes = settings_classes()
    known = {name for each in classes.values() for name in variables(each).values()}
    known.add(API_KEY_VARIABLE)
    problems = [*_unknown(environment, known)]
    for settings in classes.values():
        problems += _invalid(settings)
    yield from problems
    if not problems:
        names = sorted(name for name in environment if name.startswith(PREFIX))
        yield Finding("configuration", Status.ok, ", ".join(names) or "all defaults")
    yield from _grippers(environment)


def _unknown(environment: Mapping[str, str], known: set[str]) -> Iterator[Finding]:
    for name in sorted(environment):
        if name.startswith(PREFIX) and name not in known:
            similar = difflib.get_close_matches(name, known, n=1, cutoff=_ALIKE)
            message = f"nothing reads {name}"
            if similar:
                yield Finding("configuration", Status.fail, message, f"meant is {similar[0]}?")
            else:
                advice = "remove it; the services' settings.py list what there is"
                yield Finding("configuration", Status.warn, message, advice)


def _invalid(settings: type[BaseSettings]) -> Iterator[Finding]:
    try:
        settings()
    except ValidationError as error:
        names = variables(settings)
        for each in error.errors():
            field = str(each["loc"][0]) if each["loc"] else ""
            message = f"{names.get(field, field)}={each['input']!r}: {each['msg']}"
            yield Finding("configuration", Status.fail, message, "correct the value")


def _grippers(environment: Mapping[str, str]) -> Iterator[Finding]:
    folder = environment.get("SPARGE_GRIPPERS_DIR")
    if not folder:
        return
    try:
        names = ", ".join(load_grippers(Path(folder)))
    except ValueError as error:
        yield Finding("grippers", Status.fail, str(error), "see docs/grippers.md")
    else:
        yield Finding("grippers", Status.ok, names)
