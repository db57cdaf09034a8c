"""Program text from files, and where its O programs and N numbers stand."""

import bisect
import re
from array import array
from dataclasses import dataclass, field
from pathlib import Path

from controller.language.folder import Folder
from controller.span import Span
from controller.tables.alarms import alarm

LONGEST_LINE = 2000
"""[characters] no block is longer; what is, is not a program"""
LARGEST_FILE = 256 * 2**20
"""[bytes] what is larger is not read"""
_FILE_ENCODINGS = ("utf-8-sig", "gbk")

_COMMENT = re.compile(r"\([^)]*\)")
_BLANKS = r"(?:[ \t]|\([^)]*\))*"
_O_NUMBER = re.compile(rf"{_BLANKS}%?{_BLANKS}[Oo]{_BLANKS}(\d{{1,8}})(?!\d)", re.ASCII)
_N_NUMBER = re.compile(
    rf"(?:{_O_NUMBER.pattern})?{_BLANKS}(?:/\d?)?{_BLANKS}[Nn]{_BLANKS}(?P<label>\d{{1,8}})(?!\d)", re.ASCII
)
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0e-\x1f]")
_LABEL_BITS = 32


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockRef:
    """A block of a program, as written."""

    file: str
    line: int
    """from 1"""
    text: str


@dataclass(slots=True, kw_only=True)
class Program:
    """The lines of one file and the index of the O programs in it.

    O programs that stand in other files of the same folder are fetched when they are first called: their
    lines are appended, so an index into `lines` names a line of any file.
    """

    file: str
    lines: list[str]
    """without line ends, up to the end of tape"""
    starts: dict[int, int]
    """O number -> index into `lines`"""
    after_tape: int | None = None
    """line number of text behind the closing %, which no controller reads"""
    folder: Folder | None = None
    """where O programs stand that the file does not hold"""
    _files: list[tuple[int, str]] = field(default_factory=list)
    """(first index, file) of every fetched file"""
    _bounds: list[int] = field(default_factory=list)
    """indices behind which an O program ends, ascending"""
    _labels: dict[int, "array[int]"] = field(default_factory=dict)

    def span(self, index: int, column: int | None = None) -> Span:
        """The place of line `index` (from 0)."""
        if not self._files or index < self._files[0][0]:
            return Span(file=self.file, line=index + 1, column=column)
        first, file = self._files[bisect.bisect_right(self._files, index, key=lambda one: one[0]) - 1]
        return Span(file=file, line=index - first + 1, column=column)

    def ref(self, index: int) -> BlockRef:
        """Line `index` (from 0) as written, without surrounding blanks."""
        span = self.span(index)
        return BlockRef(file=span.file, line=span.line or 1, text=self.lines[index].strip())

    def find(self, number: int) -> int | None:
        """Index of the first line of an O program, fetched from beside the file where it must be."""
        if number not in self.starts and self.folder and (path := self.folder.find(number)):
            self._fetch(load_program(path), number)
        return self.starts.get(number)

    def end_of(self, start: int) -> int:
        """Index behind the last line of the O program that begins at line `start`."""
        if not self._bounds:
            self._bounds = _bounds(self.starts, self.lines, 0)
        return self._bounds[bisect.bisect_right(self._bounds, start)]

    def sequence(self, number: int, start: int, after: int | None = None) -> int | None:
        """Index of the line with sequence number N in the O program that begins at `start`.

        Of several the first one behind line `after` is meant, else the first one of the program.
        """
        labels = self._labels.get(start)
        if labels is None:
            labels = self._labels[start] = self._index_labels(start)
        for line in (start if after is None else after + 1, start):
            k = bisect.bisect_left(labels, number << _LABEL_BITS | line)
            if k < len(labels) and labels[k] >> _LABEL_BITS == number:
                return labels[k] & (1 << _LABEL_BITS) - 1
        return None

    def label_of(self, index: int, start: int) -> int | None:
        """The sequence number that stands on line `index` or nearest above it, from `start` on."""
        for k in range(index, start - 1, -1):
            if found := _N_NUMBER.match(self.lines[k]):
                return int(found["label"])
        return None

    def _index_labels(self, start: int) -> "array[int]":
        """All N numbers of an O program as number · 2³² + line, ascending: 8 bytes a label."""
        labels = array("q")
        for index in range(start, self.end_of(start)):
            if found := _N_NUMBER.match(self.lines[index]):
                labels.append(int(found["label"]) << _LABEL_BITS | index)
        return array("q", sorted(labels))

    def _fetch(self, other: "Program", number: int) -> None:
        """Append the lines of another file; where two files hold the same O number the first one is kept."""
        first = len(self.lines)
        bounds = self._bounds or _bounds(self.starts, self.lines, 0)
        starts = other.starts or {number: 0}
        self._bounds = bounds + _bounds(starts, other.lines, first)
        self._files.append((first, other.file))
        self.lines.extend(other.lines)
        self.starts = {o: k + first for o, k in starts.items()} | self.starts


def _bounds(starts: dict[int, int], lines: list[str], first: int) -> list[int]:
    """Where the O programs of one file end: at the next one, or at the end of the file.

    Blocks before the first O number are a program without number, which ends there.
    """
    heads = sorted(starts.values())
    own = heads[:1] if heads and any(is_block(line) for line in lines[: heads[0]]) else []
    return [first + line for line in [*own, *heads[1:], len(lines)]]


def load_program(path: Path | str) -> Program:
    """Read a program in UTF-8 or GBK: a file, or a folder of files, of which O0001 is run, else the lowest.

    Raises AlarmError HT9000 for what cannot be read or is no text, HT9001 for an empty file or folder.
    """
    path = Path(path)
    if path.is_dir():
        main = Folder(path).main()
        if main is None:
            valid = "files with an O number, such as O0001.nc"
            raise alarm("HT9001", "a folder without a program", Span(file=str(path)), valid=valid)
        path = main
    span = Span(file=str(path))
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST_FILE + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else None
        raise alarm("HT9000", reason or "a name that no file can have", span) from error
    if len(data) > LARGEST_FILE:
        raise alarm("HT9000", "a very large file", span, valid=f"at most {LARGEST_FILE >> 20} MiB")
    for encoding in _FILE_ENCODINGS:
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        del data
        program = parse_program(text, file=str(path))
        program.folder = Folder(path.parent, own=path)
        return program
    raise alarm("HT9000", "bytes that are neither UTF-8 nor GBK", span)


def parse_program(text: str, file: str = "program.nc") -> Program:
    """Split a program text into lines.

    Raises AlarmError HT9000 for control characters or endless lines, HT9001 for a text without a block.
    """
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    if found := _CONTROL.search(text):
        line, column = (
            text.count("\n", 0, found.start()) + 1,
            found.start() - text.rfind("\n", 0, found.start()),
        )
        place = Span(file=file, line=line, column=column)
        raise alarm("HT9000", f"the control character {ord(found.group()):#04x}", place)
    lines = text.split("\n")
    for index, line in enumerate(lines):
        if len(line) > LONGEST_LINE:
            place = Span(file=file, line=index + 1, column=LONGEST_LINE + 1)
            raise alarm("HT9000", f"a line of {len(line)} characters", place, valid=f"at most {LONGEST_LINE}")
    after_tape = _cut_tape(lines)
    if not any(is_block(line) for line in lines):
        raise alarm("HT9001", "no block", Span(file=file, line=1, column=1))
    starts: dict[int, int] = {}
    for index, line in enumerate(lines):
        if ("O" in line or "o" in line) and (found := _O_NUMBER.match(line)):
            number = int(found.group(1))
            if number in starts:
                place = Span(file=file, line=index + 1, column=1)
                raise alarm("HT9012", f"O{number:04d} for the second time", place, valid="each O number once")
            starts[number] = index
    return Program(file=file, lines=lines, starts=starts, after_tape=after_tape)


def _cut_tape(lines: list[str]) -> int | None:
    """Drop the closing % and what follows; the line number of text that followed, if any."""
    seen = 0
    for index, line in enumerate(lines):
        if "%" in line and line.lstrip().startswith("%"):
            if any(is_block(one) for one in lines[seen:index]):
                rest = next((k + 1 for k in range(index + 1, len(lines)) if lines[k].strip()), None)
                del lines[index:]
                return rest
            seen = index
    return None


def is_block(line: str) -> bool:
    """Whether a line holds more than blanks, comments, % and ;"""
    return bool(_COMMENT.sub("", line).strip(" \t%;；"))
