"""A stand-in for rclpy and the message packages, since no ROS is installed where the tests run.

Messages have the fields of `ros_messages.DEFINITIONS` and refuse others and wrong types, as the
classes that rosidl generates do; a node only keeps what it is given. It shows that a node's
calls fit together, not that ROS would take them.
"""

from __future__ import annotations

import array
from collections.abc import Callable
from types import ModuleType, SimpleNamespace
from typing import Any

from tests.support.ros_messages import DEFINITIONS, fields_of

_DEFAULTS: dict[str, tuple[type, Any]] = {
    "string": (str, ""),
    "bool": (bool, False),
    "float64": (float, 0.0),
    **dict.fromkeys(("int32", "uint32", "uint8"), (int, 0)),
}


def message_class(kind: str) -> type:
    """Return the class of a message, as rosidl's Python generator makes it."""
    fields = fields_of(kind)

    def __init__(self: Any, **given: Any) -> None:  # noqa: N807
        assert set(given) <= set(fields), f"{kind} has no {set(given) - set(fields)}"
        for name, of in fields.items():
            setattr(self, name, given.get(name, _default(of)))

    def __setattr__(self: Any, name: str, value: Any) -> None:  # noqa: N807
        assert name in fields, f"{kind} has no field {name!r}"
        _require(fields[name], value, f"{kind}.{name}")
        object.__setattr__(self, name, value)

    members = {"__init__": __init__, "__setattr__": __setattr__, "kind": kind}
    return type(kind.rsplit("/", 1)[1], (), members)


_CLASSES: dict[str, type] = {}


def _class_of(kind: str) -> type:
    return _CLASSES.setdefault(kind, message_class(kind))


def _default(of: str) -> Any:
    if of == "uint8[]":
        return array.array("B")
    if of.endswith("[]"):
        return []
    return _DEFAULTS[of][1] if of in _DEFAULTS else _class_of(of)()


def _require(of: str, value: Any, where: str) -> None:
    if of == "uint8[]":
        assert isinstance(value, array.array | bytes), f"{where} is no array of bytes"
    elif of.endswith("[]"):
        for each in value:
            _require(of[:-2], each, where)
    elif of in _DEFAULTS:
        kind = _DEFAULTS[of][0]
        exact = isinstance(value, kind) and (kind is bool or not isinstance(value, bool))
        assert exact, f"the field {where} must be of type {kind.__name__}, is {value!r}"
    else:
        assert isinstance(value, _class_of(of)), f"{where} must be a {of}"


class Node:
    """Keeps what it is told, for a test to look at and to call."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.parameters: dict[str, Any] = {}
        self.published: dict[str, list[Any]] = {}
        self.callbacks: dict[str, Callable[..., Any]] = {}
        self.logged: list[str] = []

    def declare_parameter(self, name: str, default: Any) -> Any:
        assert name not in self.parameters
        self.parameters[name] = default
        return self.get_parameter(name)

    def get_parameter(self, name: str) -> Any:
        return SimpleNamespace(name=name, value=self.parameters[name])

    def create_publisher(self, kind: type, topic: str, qos: Any) -> Any:
        sent = self.published.setdefault(topic, [])

        def publish(message: Any) -> None:
            assert isinstance(message, kind), f"{topic} takes {kind.__name__}"
            sent.append(message)

        return SimpleNamespace(publish=publish)

    def create_subscription(self, kind: type, topic: str, callback: Any, qos: Any) -> Any:
        self.callbacks[topic] = callback
        return SimpleNamespace(topic=topic)

    def create_service(self, kind: type, name: str, callback: Any) -> Any:
        assert hasattr(kind, "Request")
        self.callbacks[name] = callback
        return SimpleNamespace(name=name)

    def get_logger(self) -> Any:
        return SimpleNamespace(error=self.logged.append, info=self.logged.append)

    def destroy_node(self) -> None:
        self.callbacks.clear()


def modules() -> dict[str, ModuleType]:
    """Return the stand-ins by the names that they are imported as."""
    contents: dict[str, dict[str, Any]] = {
        "rclpy": {"init": lambda: None, "spin": lambda node: None, "shutdown": lambda: None},
        "rclpy.node": {"Node": Node},
        "rclpy.qos": {"qos_profile_sensor_data": object()},
    }
    for kind in DEFINITIONS:
        package, name = kind.split("/")
        if package != "std_srvs":
            contents.setdefault(package, {})
            contents.setdefault(f"{package}.msg", {})[name] = _class_of(kind)
    halves = {half: _class_of(f"std_srvs/Trigger_{half}") for half in ("Request", "Response")}
    contents |= {"std_srvs": {}, "std_srvs.srv": {"Trigger": type("Trigger", (), halves)}}
    made = {name: ModuleType(name) for name in contents}
    for name, content in contents.items():
        vars(made[name]).update(content)
    return made
