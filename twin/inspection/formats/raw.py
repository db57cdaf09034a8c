"""What a mesh file holds, as it stands there, and what the readers share."""

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.inspection.solid import Ints

COMMAS = bytes.maketrans(b" \t\r\n", b",,,,")
BLOCK = 1 << 20
"""bytes read at a time"""


class DamagedError(ValueError):
    """A file that is not what it says it is; the text says in what."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Raw:
    """Triangles in the unit of the file."""

    vertices: NDArray[np.floating]
    """(n, 3) float32 or float64"""
    faces: Ints | None
    """(m, 3) vertex indices; None: three vertices in a row are one triangle"""
    unit: str = "mm"
    """one of `units.MILLIMETRES` or `units.DECLARED`, or what else the file declares"""


def numbers(text: bytes, kind: type[np.generic] = np.float64) -> np.ndarray:
    """Return all numbers (n,) of a text that should hold nothing else, floats or whole ones.

    Raises DamagedError where it holds something else.
    """
    if not text.strip():
        return np.zeros(0, dtype=kind)
    if kind is np.float64 and (found := _floats(text)) is not None:
        return found
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # how numpy says that it stopped early
        try:
            return np.fromstring(text, dtype=kind, sep=" ")
        except (ValueError, DeprecationWarning) as fault:
            raise DamagedError("something stands there that is no number") from fault


def _floats(text: bytes) -> NDArray[np.float64] | None:
    """Return all floats of a text as a JSON decoder reads them, three times faster; None where it cannot.

    It knows neither `.5` nor `+1` nor `nan`.
    """
    return listed_floats(text.translate(COMMAS).replace(b",,", b",").replace(b",,", b",").strip(b","))


def listed_floats(listed: bytes) -> NDArray[np.float64] | None:
    """Return the floats (n,) of a list with a comma between each two; None if it is anything else."""
    import msgspec  # noqa: PLC0415 - binary files need none of this

    decoder = msgspec.json.Decoder(list[float])
    blocks, begin = [], 0
    try:
        while begin < len(listed):
            end = listed.find(b",", begin + BLOCK)
            end = len(listed) if end < 0 else end
            blocks.append(np.array(decoder.decode(b"[%b]" % listed[begin:end])))
            begin = end + 1
    except msgspec.MsgspecError:
        return None
    return np.concatenate(blocks) if blocks else None


def indices(values: NDArray[np.float64]) -> Ints:
    """Return whole numbers read as floats. Raises DamagedError for others."""
    with np.errstate(invalid="ignore"):
        whole = values.astype(np.int64)
    if not np.array_equal(whole, values):
        raise DamagedError("a vertex is named by something that is no whole number")
    return whole
