"""Words into a block: which G codes, which M code, one word an address."""

from dataclasses import dataclass

from controller.alarms import alarm
from controller.codes import G_CODES, M_CODES, GCode, MCode, Support, g_name
from controller.lexer import Word, lex
from controller.source import Program
from controller.span import Span

PLAIN_ADDRESSES = frozenset("FSTPQRLIKA")
"""addresses that exist on any machine beside G and M"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """One block as written, its codes looked up."""

    file: str
    line: int
    """from 1"""
    codes: dict[int, Word]
    """G codes in tenths -> word"""
    m_code: MCode | None
    words: dict[str, Word]
    """all other words by address; N, O and / are not among them"""
    skip: int | None
    """n of /n; None = the block is not to be skipped"""

    @property
    def span(self) -> Span:
        """The beginning of the block."""
        return Span(file=self.file, line=self.line, column=1)

    def place(self, word: Word) -> Span:
        """Where a word stands."""
        return Span(file=self.file, line=self.line, column=word.column)

    @property
    def empty(self) -> bool:
        """Whether the block asks for nothing."""
        return not (self.codes or self.words or self.m_code)


def parse_block(program: Program, index: int, letters: frozenset[str]) -> Block:
    """Read line `index` (from 0). `letters` are the axis and increment letters of the machine.

    Raises AlarmError PS0003-PS0007, PS0009 for words, PS0010 for G codes, HT9002 and HT9003 for codes the
    twin does not run, PS5016 and HT9009 for M codes, PS5074 for what stands twice.
    """
    line = index + 1
    codes: dict[int, Word] = {}
    words: dict[str, Word] = {}
    m_code: MCode | None = None
    skip: int | None = None
    for word in lex(program.lines[index], program.file, line):
        place = Span(file=program.file, line=line, column=word.column)
        address = word.address
        if address == "G":
            _add_code(codes, word, place)
        elif address == "M":
            if m_code:
                raise alarm("PS5016", f"{word} beside {m_code.name}", place)
            m_code = _m_code(word, place)
        elif address == "/":
            skip = int(word.text or 1)
        elif address in "NO":
            _check_label(word, place)
        elif address in PLAIN_ADDRESSES or address in letters:
            if address in words:
                raise alarm("PS5074", f"{address} for the second time", place)
            words[address] = word
        else:
            valid = ", ".join(sorted(letters)) + " for the axes of this machine, " + ", ".join("FSTGMPQRLIK")
            raise alarm("PS0009", str(word), place, valid=valid)
    return Block(file=program.file, line=line, codes=codes, m_code=m_code, words=words, skip=skip)


def _check_label(word: Word, place: Span) -> None:
    if word.has_point:
        raise alarm("PS0007", str(word), place)
    if word.text.startswith("-"):
        raise alarm("PS0006", str(word), place)


def _add_code(codes: dict[int, Word], word: Word, place: Span) -> None:
    code = _g_code(word, place)
    for other in codes:
        if G_CODES[other].group is code.group:
            found = f"{code.name} beside {g_name(other)} of the same group"
            raise alarm("PS5074", found, place)
    if code.support is not Support.RUNS:
        number = "HT9002" if code.support is Support.LATER else "HT9003"
        raise alarm(number, f"{code.name}, {code.meaning}", place)
    codes[code.tenths] = word


def _g_code(word: Word, place: Span) -> GCode:
    whole, _, tenth = word.text.partition(".")
    if word.text.startswith("-"):
        raise alarm("PS0006", str(word), place)
    digits = whole.lstrip("+") or "0"
    tenth = tenth.rstrip("0") or "0"
    code = G_CODES.get(int(digits) * 10 + int(tenth)) if len(tenth) == 1 else None
    if code is None:
        raise alarm("PS0010", str(word), place)
    return code


def _m_code(word: Word, place: Span) -> MCode:
    if word.has_point:
        raise alarm("PS0007", str(word), place)
    if word.text.startswith("-"):
        raise alarm("PS0006", str(word), place)
    code = M_CODES.get(int(word.text))
    if code is None:
        valid = ", ".join(one.name for one in M_CODES.values())
        raise alarm("HT9009", str(word), place, valid=valid)
    return code
