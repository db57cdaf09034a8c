"""Words into a block: which G codes, which M code, one word an address."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from controller.language.lexer import OpenWord, Word, lex
from controller.language.macro.statement import Statement, parse_statement
from controller.language.quantities import WHOLE
from controller.language.source import Program
from controller.span import Span
from controller.tables.alarms import alarm
from controller.tables.codes import G_CODES, M_CODES, GCode, MCode, Support, g_name, nearest_names

PLAIN_ADDRESSES = frozenset("FSTPQRLIJKA")
"""addresses that exist on any machine beside G and M"""
MACRO_CALLS = frozenset((650, 660))
"""G65, G66: all other words of their block are arguments"""
_CYCLES = frozenset((710, 720, 730, 760))
"""G71, G72, G73, G76, which other controls write in one block, with D"""
_NO_ARGUMENTS = frozenset("GNO/")


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
    arguments: tuple[Word, ...] = ()
    """of a macro call, in the order they are written"""
    m_word: Word | None = None
    """where `m_code` is written"""

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
        return not (self.codes or self.words or self.m_code or self.arguments)


@dataclass(frozen=True, slots=True, kw_only=True)
class OpenBlock:
    """A block with expressions: its words are looked up when they are known."""

    span: Span
    words: tuple[Word | OpenWord, ...]
    skip: int | None


Line = Block | OpenBlock | Statement


def read_line(program: Program, index: int, letters: frozenset[str]) -> Line:
    """Read line `index` (from 0). `letters` are the axis and increment letters of the machine.

    Raises AlarmError PS0003-PS0007, PS0009 for words, PS0010 for G codes, HT9003 for codes the twin does not
    run, PS5016 and HT9009 for M codes, PS5074 for what stands twice, PS0114-PS0128 for macro statements.
    """
    span = program.span(index, 1)
    line_number = span.line or 1
    text = program.lines[index]
    if statement := parse_statement(text, span.file, line_number):
        return statement
    words = lex(text, span.file, line_number)
    closed = [word for word in words if isinstance(word, Word)]
    if len(closed) < len(words):
        skip = next((int(word.text or 1) for word in closed if word.address == "/"), None)
        return OpenBlock(span=span, words=tuple(words), skip=skip)
    return build_block(closed, span, letters)


def build_block(words: Sequence[Word], span: Span, letters: frozenset[str]) -> Block:
    """Look the words of one block up. Raises AlarmError as `read_line` does."""
    codes: dict[int, Word] = {}
    others: dict[str, Word] = {}
    m_code: MCode | None = None
    m_word: Word | None = None
    skip: int | None = None

    def place(word: Word) -> Span:
        return Span(file=span.file, line=span.line, column=word.column)

    for k, word in enumerate(words):
        address = word.address
        if address == "G":
            code = _g_code(word, place)
            _check_code(codes, code, word, place)
            codes[code.tenths] = word
            if code.tenths in MACRO_CALLS:
                return _macro_call(words, k, codes, span, skip)
        elif address == "M":
            if m_code:
                raise alarm("PS5016", f"{word} beside {m_code.name}", place(word))
            m_code, m_word = _m_code(word, place), word
        elif address == "/":
            skip = int(word.text or 1)
        elif address in "NO":
            _check_label(word, place(word), [before.address for before in words[:k]])
        elif address in PLAIN_ADDRESSES or address in letters:
            if address in others:
                raise alarm("PS5074", f"{address} for the second time", place(word))
            others[address] = word
        else:
            valid = ", ".join(sorted(letters)) + " for the axes of this machine, " + ", ".join("FSTGMPQRLIJK")
            if address == "D" and not _CYCLES.isdisjoint(codes):
                valid = f"the two-block form: G71 U R, then G71 P Q U W; likewise {g_name(max(codes))}"
            raise alarm("PS0009", str(word), place(word), valid=valid)
    line = span.line or 1
    return Block(
        file=span.file, line=line, codes=codes, m_code=m_code, words=others, skip=skip, m_word=m_word
    )


def _macro_call(
    words: Sequence[Word], call: int, codes: dict[int, Word], span: Span, skip: int | None
) -> Block:
    """G65 or G66: P, L and the arguments."""
    others: dict[str, Word] = {}
    arguments: list[Word] = []
    for k, word in enumerate(words):
        place = Span(file=span.file, line=span.line, column=word.column)
        if k == call or (k < call and word.address in "/NO"):
            continue
        if len(codes) > 1 or word.address in _NO_ARGUMENTS:
            raise alarm("PS0129", f"{word} in the block of {words[call]}", place)
        if word.address in "PL":
            if word.address in others:
                raise alarm("PS5074", f"{word.address} for the second time", place)
            others[word.address] = word
        else:
            arguments.append(word)
    line = span.line or 1
    return Block(
        file=span.file,
        line=line,
        codes=codes,
        m_code=None,
        words=others,
        skip=skip,
        arguments=tuple(arguments),
    )


def _check_label(word: Word, place: Span, before: Sequence[str]) -> None:
    """O or N, with the addresses before it: further back nothing would find it."""
    if any(address not in ("/", "O") or word.address == "O" for address in before):
        valid = f"{word.address} at the beginning of the block"
        raise alarm("PS0009", f"{word} behind {before[-1]}", place, valid=valid)
    if word.has_point:
        raise alarm("PS0007", str(word), place)
    if word.negative:
        raise alarm("PS0006", str(word), place)


def _check_code(codes: dict[int, Word], code: GCode, word: Word, place: Callable[[Word], Span]) -> None:
    for other in codes:
        if G_CODES[other].group is code.group:
            found = f"{code.name} beside {g_name(other)} of the same group"
            raise alarm("PS5074", found, place(word))
    if code.support is Support.NEVER:
        raise alarm("HT9003", f"{code.name}, {code.meaning}", place(word), valid=code.instead)


def _g_code(word: Word, place: Callable[[Word], Span]) -> GCode:
    if word.negative:
        raise alarm("PS0006", str(word), place(word))
    tenths = _tenths(word)
    code = None if tenths is None else G_CODES.get(tenths)
    if code is None:
        raise alarm(
            "PS0010",
            str(word),
            place(word),
            valid=nearest_names(float(word.text) if word.value is None else word.value),
        )
    return code


def _tenths(word: Word) -> int | None:
    """The number of a G code in tenths; None where it has more decimals than one."""
    if word.value is not None:
        tenths = round(word.value * 10.0)
        return tenths if abs(word.value * 10.0 - tenths) < WHOLE else None
    whole, _, tenth = word.text.partition(".")
    tenth = tenth.rstrip("0") or "0"
    return int(whole.lstrip("+") or "0") * 10 + int(tenth) if len(tenth) == 1 else None


def _m_code(word: Word, place: Callable[[Word], Span]) -> MCode:
    if word.has_point or (word.value is not None and abs(word.value - round(word.value)) > WHOLE):
        raise alarm("PS0007", str(word), place(word))
    if word.negative:
        raise alarm("PS0006", str(word), place(word))
    code = M_CODES.get(int(word.text) if word.value is None else round(word.value))
    if code is None:
        valid = ", ".join(one.name for one in M_CODES.values())
        raise alarm("HT9009", str(word), place(word), valid=valid)
    return code
