"""Program text from a file, and where its O programs and N numbers stand."""

import re
from dataclasses import dataclass, field
from pathlib import Path

from controller.alarms import alarm
from controller.span import Span

LONGEST_LINE = 2000
"""[characters] no block is longer; what is, is not a program"""

_COMMENT = re.compile(r"\([^)]*\)")
_O_NUMBER = re.compile(r"^\s*%?\s*[Oo]\s*(\d{1,8})(?!\d)", re.ASCII)
_N_NUMBER = re.compile(r"^\s*/?\d?\s*[Nn]\s*(\d{1,8})(?!\d)", re.ASCII)
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0e-\x1f]")


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockRef:
    """A block of a program, as written."""

    file: str
    line: int
    """from 1"""
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Program:
    """The lines of one file, and the index of the O programs in it."""

    file: str
    lines: tuple[str, ...]
    """without line ends, up to the end of tape"""
    starts: dict[int, int] = field(default_factory=dict)
    """O number -> index into `lines`"""
    after_tape: int | None = None
    """line number of text behind the closing %, which no controller reads"""

    def span(self, index: int, column: int | None = None) -> Span:
        """The place of line `index` (from 0)."""
        return Span(file=self.file, line=index + 1, column=column)

    def ref(self, index: int) -> BlockRef:
        """Line `index` (from 0) as written, without surrounding blanks."""
        return BlockRef(file=self.file, line=index + 1, text=self.lines[index].strip())

    def end_of(self, start: int) -> int:
        """Index behind the last line of the O program that begins at line `start`."""
        later = [index for index in self.starts.values() if index > start]
        return min(later, default=len(self.lines))

    def sequence(self, number: int, start: int) -> int | None:
        """Index of the line with sequence number N in the O program that begins at `start`."""
        for index in range(start, self.end_of(start)):
            found = _N_NUMBER.match(self.lines[index])
            if found and int(found.group(1)) == number:
                return index
        return None


def load_program(path: Path | str) -> Program:
    """Read a program file in UTF-8 or GBK.

    Raises AlarmError HT9000 for a file that cannot be read or is no text, HT9001 for an empty one.
    """
    path = Path(path)
    span = Span(file=str(path))
    try:
        data = path.read_bytes()
    except OSError as error:
        raise alarm("HT9000", error.strerror or "an unreadable file", span) from error
    for encoding in ("utf-8-sig", "gbk"):
        try:
            return parse_program(data.decode(encoding), file=str(path))
        except UnicodeDecodeError:
            continue
    raise alarm("HT9000", "bytes that are neither UTF-8 nor GBK", span)


def parse_program(text: str, file: str = "program.nc") -> Program:
    """Split a program text into lines.

    Raises AlarmError HT9000 for control characters or endless lines, HT9001 for a text without a block.
    """
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    tape: list[str] = []
    after_tape = None
    for index, line in enumerate(lines):
        if found := _CONTROL.search(line):
            place = Span(file=file, line=index + 1, column=found.start() + 1)
            raise alarm("HT9000", f"the control character {ord(found.group()):#04x}", place)
        if len(line) > LONGEST_LINE:
            place = Span(file=file, line=index + 1, column=LONGEST_LINE + 1)
            raise alarm("HT9000", f"a line of {len(line)} characters", place, valid=f"at most {LONGEST_LINE}")
        if line.strip().startswith("%") and any(_is_block(one) for one in tape):
            after_tape = next((k + 1 for k in range(index + 1, len(lines)) if lines[k].strip()), None)
            break
        tape.append(line)
    if not any(_is_block(line) for line in tape):
        raise alarm("HT9001", "no block", Span(file=file, line=1, column=1))
    starts: dict[int, int] = {}
    for index, line in enumerate(tape):
        if found := _O_NUMBER.match(_COMMENT.sub(" ", line)):
            number = int(found.group(1))
            if number in starts:
                place = Span(file=file, line=index + 1, column=1)
                raise alarm("HT9012", f"O{number:04d} for the second time", place, valid="each O number once")
            starts[number] = index
    return Program(file=file, lines=tuple(tape), starts=starts, after_tape=after_tape)


def _is_block(line: str) -> bool:
    return bool(_COMMENT.sub("", line).strip(" \t%;；"))
