"""O programs that stand in files of their own: found by the first O number in the file, else by its name."""

import re
from pathlib import Path

SUFFIXES = frozenset({"", ".nc", ".cnc", ".tap", ".txt", ".iso", ".min", ".prg", ".mpf"})
"""endings of program files, small letters"""
MOST_FILES = 2000
"""files of a folder that are looked at"""
_HEAD = 4096
"""[bytes] the O number stands within so many"""
_FIRST_BLOCK = re.compile(rb"(?:[\s%;]|\xef\xbb\xbf|\([^)]*\))*[Oo][ \t]*(\d{1,8})(?!\d)")
_NAME = re.compile(r"[Oo](\d{1,8})(?:\..*)?", re.ASCII)


class Folder:
    """The programs of one folder by O number. Nothing is read before the first question."""

    def __init__(self, path: Path, own: Path | None = None) -> None:
        self._path = path
        self._own = own
        self._programs: dict[int, Path] | None = None

    def find(self, number: int) -> Path | None:
        """The file that holds an O program, the file `own` excepted."""
        return self._index().get(number)

    def main(self) -> Path | None:
        """The program to start with: O0001, else the lowest number; None where there is none."""
        programs = self._index()
        return programs.get(1) or (programs[min(programs)] if programs else None)

    def _index(self) -> dict[int, Path]:
        if self._programs is None:
            self._programs = {}
            for path in self._candidates():
                number = _number_of(path)
                if number is not None:
                    self._programs.setdefault(number, path)
        return self._programs

    def _candidates(self) -> list[Path]:
        try:
            files = sorted(self._path.iterdir())[:MOST_FILES]
            own = self._own.resolve() if self._own else None
            return [p for p in files if p.suffix.lower() in SUFFIXES and p.is_file() and p.resolve() != own]
        except OSError:
            return []


def _number_of(path: Path) -> int | None:
    """The O number a file begins with, else that of its name; None for a file that is no program."""
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD)
    except OSError:
        return None
    if found := _FIRST_BLOCK.match(head):
        return int(found.group(1))
    named = _NAME.fullmatch(path.name)
    return int(named.group(1)) if named else None
