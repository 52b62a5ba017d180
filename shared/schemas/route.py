"""A route is declared once and used by both sides: the service serves it, the client calls it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from shared.wire import Message

Request = TypeVar("Request", bound=Message)
Response = TypeVar("Response", bound=Message)


class Nothing(Message):
    """The empty message: what a GET sends."""


@dataclass(frozen=True)
class Route(Generic[Request, Response]):
    """An endpoint of one service.

    Attributes
    ----------
    service : str
        Which service serves it.
    path : str
        May hold `{name}` parts, filled from the request's fields of that name.
    request, response : type
        The messages.
    summary : str
        One line for the OpenAPI page.
    method : str
        GET and DELETE carry no body.
    changes : bool
        It changes what is known, and may be refused because of what is known.
    """

    service: str
    path: str
    request: type[Request]
    response: type[Response]
    summary: str
    method: str = "POST"
    changes: bool = False
