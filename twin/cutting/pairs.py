"""Ragged lists of pairs (item, bite), and work on them in batches that fit the cache."""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

S = TypeVar("S")
T = TypeVar("T")

BATCH = 1 << 13
"""Pairs in one batch: every intermediate array stays under the 128 KiB that malloc keeps at hand."""
LISTED = 1 << 16
"""Pairs in one batch where only a few of them are evaluated."""


@dataclass(frozen=True, slots=True)
class Candidates:
    """For each item the bites that may be the deepest one there."""

    start: Ints
    """(n + 1,) where each item's list begins in `bites`"""
    bites: Ints
    """(m,) bite numbers"""

    @property
    def count(self) -> int:
        """Number of items."""
        return len(self.start) - 1

    def owner(self) -> Ints:
        """(m,) item of each pair."""
        return np.repeat(np.arange(self.count), np.diff(self.start))

    def of(self, items: Ints) -> "Candidates":
        """The lists of some items, in their order; an item may come more than once."""
        start = np.concatenate([[0], np.cumsum(np.diff(self.start)[items])])
        return Candidates(start, self.bites[self.pairs(items)])

    def pairs(self, items: Ints) -> Ints:
        """Where the pairs of some items stand in `bites`, in the items' order."""
        length = np.diff(self.start)[items]
        end = np.cumsum(length)
        # self.start of the item, plus the position in its list
        pairs = np.repeat(self.start[items] - end + length, length)
        pairs += np.arange(len(pairs))
        return pairs

    def where(self, keep: NDArray[np.bool_]) -> "Candidates":
        """The lists without the pairs that are not kept (m,)."""
        kept = np.concatenate([[0], np.cumsum(keep)])
        return Candidates(kept[self.start], self.bites[keep])


def join(parts: list[Candidates]) -> Candidates:
    """Lists of several parts, one after the other."""
    if not parts:
        return Candidates(np.zeros(1, dtype=np.int64), np.zeros(0, dtype=np.int64))
    lengths = np.concatenate([np.diff(p.start) for p in parts])
    return Candidates(np.concatenate([[0], np.cumsum(lengths)]), np.concatenate([p.bites for p in parts]))


def batches(start: Ints, size: int = BATCH) -> Iterator[slice]:
    """Slices of items with about `size` pairs each."""
    cut = np.searchsorted(start, np.arange(size, start[-1] + size, size))
    low = 0
    for high in np.unique(np.minimum(cut, len(start) - 1)):
        if high > low:
            yield slice(low, int(high))
            low = int(high)
    if low < len(start) - 1:
        yield slice(low, len(start) - 1)


def in_parallel(work: Callable[[S], T], slices: Iterator[S]) -> list[T]:
    """`work` on every slice, results in order; the arrays' own loops run outside the interpreter lock."""
    parts = list(slices)
    if len(parts) < 2:
        return [work(part) for part in parts]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(work, parts))


def leaders(values: Floats, start: Ints, owner: Ints | None = None) -> tuple[Floats, Ints]:
    """Largest value of each non-empty list and the position where it first stands.

    Lists must not be empty. `owner` (m,) is the list of each value, where that is known.
    """
    if owner is None:
        owner = np.repeat(np.arange(len(start) - 1), np.diff(start))
    largest = np.maximum.reduceat(values, start[:-1])
    # of several the first is written last
    hit = np.flatnonzero(values == largest.take(owner))[::-1]
    first = np.zeros(len(largest), dtype=np.int64)
    first[owner.take(hit)] = hit
    return largest, first
