"""A 16-bit PNG depth image, from bytes that nobody vouches for."""

from __future__ import annotations

import io
import struct
import zlib

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from shared.errors import InvalidInput, MalformedRequest, PayloadTooLarge

MAX_PIXELS = 4096 * 4096
_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_GREYSCALE = 0
_COLOUR_TYPES = {0: "greyscale", 2: "RGB", 3: "palette", 4: "greyscale + alpha", 6: "RGB + alpha"}


def read_depth_png(data: bytes, max_unpacked_bytes: int) -> NDArray[np.uint16]:
    """Return the pixels (H, W) of a 16-bit greyscale PNG image.

    The size that its header claims is checked before a pixel is decoded.

    Raises
    ------
    MalformedRequest
        Not a PNG file, or truncated or damaged.
    InvalidInput
        Not 16 bits per pixel, or not greyscale.
    PayloadTooLarge
        More than `MAX_PIXELS` pixels, or more bytes than `max_unpacked_bytes`.
    """
    if len(data) < 33 or not data.startswith(_SIGNATURE) or data[12:16] != b"IHDR":
        raise MalformedRequest("the file is not a PNG image")
    width, height, bits, colour_type = struct.unpack(">IIBB", data[16:26])
    allowed = min(MAX_PIXELS, max_unpacked_bytes // 2)
    if width * height > allowed:
        raise PayloadTooLarge(
            f"the PNG image has {width} x {height} pixels, allowed are {allowed}",
            found=width * height,
            allowed=allowed,
        )
    if (bits, colour_type) != (16, _GREYSCALE):
        found = f"{bits}-bit {_COLOUR_TYPES.get(colour_type, 'unknown')}"
        raise InvalidInput(
            f"the PNG image is {found}; a depth image is 16-bit greyscale",
            field="file",
            found=found,
            allowed="16-bit greyscale",
        )
    try:
        with Image.open(io.BytesIO(data), formats=["PNG"]) as image:
            pixels = np.asarray(image)
    except (OSError, ValueError, SyntaxError, EOFError, struct.error, zlib.error) as error:
        raise MalformedRequest(f"the PNG image is damaged: {error}") from None
    if pixels.shape != (height, width) or pixels.dtype.kind not in "iu":
        raise MalformedRequest("the PNG image is damaged: its content contradicts its header")
    return pixels.astype(np.uint16)
