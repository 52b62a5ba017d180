"""Structured logs: one JSON object per line, or lines for a terminal.

Standard logging all through; every service and uvicorn itself write the same
format to the standard error, whoever started them (docs/decisions/0025-observability.md).
"""

from __future__ import annotations

import logging
import logging.config
from datetime import UTC, datetime
from typing import Literal

import orjson
from opentelemetry import trace
from pydantic_settings import BaseSettings
from uvicorn.config import LOGGING_CONFIG
from uvicorn.logging import ColourizedFormatter, DefaultFormatter

from shared.service.exchange import POLLED, Exchange
from shared.service.request_id import request_id
from shared.settings import environment

_STANDARD = frozenset(vars(logging.makeLogRecord({}))) | {"message", "asctime", "color_message"}
_NO_ID = request_id.get()

access = logging.getLogger("sparge.access")


class LogSettings(BaseSettings):
    """Read from `SPARGE_LOG_*`, the same for every service.

    Attributes
    ----------
    format : {"text", "json"}
        Lines for a person, or one JSON object per line.
    level : str or None
        The least that is written; None: what uvicorn was told.
    """

    model_config = environment("log")

    format: Literal["text", "json"] = "text"
    level: Literal["debug", "info", "warning", "error"] | None = None


class JsonFormatter(logging.Formatter):
    """A record as one JSON object: time, level, message, request id, what was given as `extra`."""

    def format(self, record: logging.LogRecord) -> str:
        """Return one line; whatever JSON does not know is written as its text."""
        fields: dict[str, object] = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
            "request_id": request_id.get(),
        }
        span = trace.get_current_span().get_span_context()
        if span.is_valid:
            fields["trace_id"] = trace.format_trace_id(span.trace_id)
            fields["span_id"] = trace.format_span_id(span.span_id)
        fields |= {name: value for name, value in vars(record).items() if name not in _STANDARD}
        if record.exc_info:
            fields["exception"] = self.formatException(record.exc_info)
        if record.stack_info:
            fields["stack"] = self.formatStack(record.stack_info)
        return orjson.dumps(fields, default=str, option=orjson.OPT_NON_STR_KEYS).decode()


class TextFormatter(DefaultFormatter):
    """A line for a terminal, in uvicorn's manner, with the request's id at its end."""

    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802  # logging's name
        """Return the line without a traceback."""
        line = super().formatMessage(record)
        identifier = request_id.get()
        return line if identifier == _NO_ID else f"{line} [{identifier}]"


def configure_logging(settings: LogSettings | None = None) -> None:
    """Write the logs of this process in the format that is set, if uvicorn runs it.

    Called when an application is made, which is after uvicorn has set its own logging up
    and before it says a word. Nothing is changed in a process that uvicorn does not run
    (the command line, a test) or that was given a logging configuration of its own.
    """
    server = logging.getLogger("uvicorn")
    handlers = [each for each in server.handlers if isinstance(each.formatter, ColourizedFormatter)]
    if not handlers:
        return
    settings = settings or LogSettings()
    errors = logging.getLogger("uvicorn.error")
    if settings.level is not None:
        errors.setLevel(settings.level.upper())
    logging.getLogger("sparge").setLevel(errors.getEffectiveLevel())
    formatter = (
        JsonFormatter()
        if settings.format == "json"
        else TextFormatter("%(levelprefix)s %(message)s")
    )
    for handler in handlers:
        handler.setFormatter(formatter)
        if not logging.root.handlers:
            logging.root.addHandler(handler)
    # Every service says what it answered itself, with the id.
    logging.getLogger("uvicorn.access").handlers = []


def log_as_a_server() -> None:
    """Write logs as under uvicorn, in a server that uvicorn does not run."""
    logging.config.dictConfig(LOGGING_CONFIG)
    configure_logging()


def log_exchange(service: str, exchange: Exchange) -> None:
    """Write the one line of a request; at debug what machines poll and what is a mere step."""
    quiet = exchange.inside or exchange.route in POLLED
    level = logging.DEBUG if quiet else logging.INFO
    if not access.isEnabledFor(level):
        return
    ms = round(1e3 * exchange.seconds, 3)
    access.log(
        level,
        "%s %s %s %d in %.0f ms",
        *(service, exchange.method, exchange.route, exchange.status, ms),
        extra={
            "service": service,
            "method": exchange.method,
            "route": exchange.route,
            "status": exchange.status,
            "ms": ms,
            "bytes_in": exchange.bytes_in,
            "bytes_out": exchange.bytes_out,
            "client": exchange.client,
            **({"code": exchange.error_code} if exchange.error_code else {}),
        },
    )
