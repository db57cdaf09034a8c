"""Which block was executed when."""

from array import array

from controller.language.source import BlockRef, Program

_MDI = "MDI"
"""in place of a file name"""


class BlockLog:
    """Which block began when: a million of them in a few megabytes."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._keyed: list[BlockRef] = []
        self.starts = array("d")
        """[s]"""
        self.indices = array("q")
        """line index of the program; -1, -2, … the blocks of MDI"""

    def begin(self, time: float, index: int) -> None:
        """A block of the program begins."""
        self.starts.append(time)
        self.indices.append(index)

    def begin_mdi(self, time: float, text: str) -> None:
        """A block from the keyboard begins."""
        self._keyed.append(BlockRef(file=_MDI, line=1, text=text))
        self.begin(time, -len(self._keyed))

    def ref(self, index: int) -> BlockRef:
        """The block of an index, as written."""
        return self._program.ref(index) if index >= 0 else self._keyed[-1 - index]
