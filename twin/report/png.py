"""Pixels as PNG (RFC 2083): one picture, unfiltered or with rows as differences, no library needed."""

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_TRUE_COLOUR_ALPHA, _INDEXED = 6, 3
_SUB = 1
"""filter type: each byte less that of the pixel before"""


def png_rgba(pixels: NDArray[np.uint8], level: int = 6) -> bytes:
    """Encode (height, width, 4) red, green, blue and opacity; `level` of compression 0 … 9."""
    height, width, _ = pixels.shape
    rows = np.zeros((height, 1 + 4 * width), np.uint8)
    rows[:, 0] = _SUB
    rows[:, 1:5] = pixels[:, :1].reshape(height, 4)
    rows[:, 5:] = (pixels[:, 1:] - pixels[:, :-1]).reshape(height, -1)
    return _file(width, _TRUE_COLOUR_ALPHA, rows, level)


def png_indexed(index: NDArray[np.uint8], palette: NDArray[np.uint8], level: int = 6) -> bytes:
    """Encode (height, width) indices into a palette (n, 4) of red, green, blue and opacity, n <= 256."""
    height, width = index.shape
    rows = np.zeros((height, 1 + width), np.uint8)
    rows[:, 1:] = index
    tables = _chunk(b"PLTE", palette[:, :3].tobytes()) + _chunk(b"tRNS", palette[:, 3].tobytes())
    return _file(width, _INDEXED, rows, level, tables)


def _file(width: int, kind: int, rows: NDArray[np.uint8], level: int, tables: bytes = b"") -> bytes:
    header = struct.pack(">IIBBBBB", width, len(rows), 8, kind, 0, 0, 0)
    data = zlib.compress(rows.tobytes(), level)
    return _SIGNATURE + _chunk(b"IHDR", header) + tables + _chunk(b"IDAT", data) + _chunk(b"IEND", b"")


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
