"""The numbers under which a recording knows the executed blocks."""

import bisect

import numpy as np
from numpy.typing import NDArray

from controller.language.block_log import BlockLog
from controller.language.source import BlockRef


class BlockNumbers:
    """Numbers the blocks in the order of their first execution; a line keeps its number."""

    def __init__(self) -> None:
        self._refs: list[BlockRef] = []
        self._numbers: dict[int, int] = {}
        self._entries = 0

    def numbers(self, log: BlockLog, time: NDArray[np.float64]) -> NDArray[np.int32]:
        """(n,) numbers of the blocks that are executed up to each of the ascending times (n,)."""
        first = max(bisect.bisect_left(log.starts, time[0]) - 1, 0)
        last = bisect.bisect_left(log.starts, time[-1])
        self._take(log, last)
        if last - first == 1:
            return np.full(len(time), self._number(log, log.indices[first]), dtype=np.int32)
        k = np.searchsorted(np.array(log.starts[first:last]), time, side="left") - 1
        numbers = [self._number(log, index) for index in log.indices[first:last]]
        # what moves before the first block, by hand, counts for the first line
        return np.array(numbers or [self._number(log, 0)], dtype=np.int32)[np.maximum(k, 0)]

    def up_to(self, log: BlockLog, time: float) -> tuple[BlockRef, ...]:
        """The blocks that have begun by `time` [s], by number."""
        self._take(log, bisect.bisect_right(log.starts, time))
        return tuple(self._refs)

    def planned_anew(self, log: BlockLog, time: float) -> None:
        """What was to begin after `time` [s] may be something else now."""
        self._entries = min(self._entries, bisect.bisect_right(log.starts, time))

    def _take(self, log: BlockLog, count: int) -> None:
        for index in log.indices[self._entries : count]:
            self._number(log, index)
        self._entries = max(self._entries, count)

    def _number(self, log: BlockLog, index: int) -> int:
        if index not in self._numbers:
            self._numbers[index] = len(self._refs)
            self._refs.append(log.ref(index))
        return self._numbers[index]
