"""How messages travel: JSON or npz, with limits."""

from shared.wire.arrays import ArrayField
from shared.wire.codec import JSON, NPZ, decode, encode
from shared.wire.message import Message

__all__ = ["JSON", "NPZ", "ArrayField", "Message", "decode", "encode"]
