"""Whole numbers out of text, all at once: a byte at a time would cost more than the rest of a file."""

import numpy as np
from numpy.typing import NDArray

from twin.inspection.solid import Ints

LONGEST = 9
"""digits of a number that fits into 32 bits"""


def whole_numbers(text: NDArray[np.uint8], begin: Ints, end: Ints) -> Ints | None:
    """Return the numbers (n,) that stand in digits at begin up to end (n,); None where something else does.

    Every number has some byte before it.
    """
    length = end - begin
    if len(length) == 0 or length.min() < 1 or length.max() > LONGEST:
        return None
    value = np.zeros(len(length), dtype=np.int32)
    for place in range(int(length.max())):
        digit = text.take(end - (place + 1), mode="clip") - np.uint8(ord("0"))
        there = length > place
        if (there & (digit > 9)).any():
            return None
        value += np.where(there, digit, 0) * np.int32(10**place)
    return value.astype(np.int64)
