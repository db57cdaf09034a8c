"""Numbers of a block become lengths, angles, times, integers (rulings, section 1, Numbers; parameter 3401#0).

A number with a point, or with DPI = 1, counts units; one without a point and DPI = 0 counts least increments
(0.001 mm, 0.0001 inch, 0.001 deg) and is warned about. Finer than one increment is truncated.
"""

from collections.abc import Callable
from dataclasses import dataclass

from controller.alarms import Alarm, alarm
from controller.gearbox import MM_PER_INCH
from controller.lexer import Word
from controller.span import Span

METRIC_DIGITS = 3
INCH_DIGITS = 4


def truncated(text: str, digits: int) -> float:
    """A decimal number cut off behind `digits` decimals; exact, because it is done on the text."""
    point = text.find(".")
    return float(text if point < 0 else text[: point + 1 + digits])


@dataclass(frozen=True, slots=True, kw_only=True)
class Reader:
    """Reads the words of one block in the units that hold there."""

    inch: bool
    calculator: bool
    """DPI = 1"""
    place: Callable[[Word], Span]
    warn: Callable[[Alarm], None]

    def length(self, word: Word) -> float:
        """[mm]"""
        digits = INCH_DIGITS if self.inch else METRIC_DIGITS
        return self._decimal(word, digits, "in" if self.inch else "mm") * (MM_PER_INCH if self.inch else 1.0)

    def angle(self, word: Word) -> float:
        """[deg]"""
        return self._decimal(word, METRIC_DIGITS, "deg")

    def pitch(self, word: Word) -> float:
        """Q of G81: module [mm] or, in inches, diametral pitch [1/inch]."""
        return self._decimal(word, METRIC_DIGITS, "1/in" if self.inch else "mm")

    def feed(self, word: Word, *, per_revolution: bool) -> float:
        """F in programmed units: mm/min or inch/min, mm or inch per revolution. Raises PS0006."""
        if word.text.startswith("-"):
            raise alarm("PS0006", str(word), self.place(word))
        value = float(word.text)
        counted = per_revolution and not self.calculator and not word.has_point
        return value * (0.0001 if self.inch else 0.01) if counted else value

    def seconds(self, word: Word) -> float:
        """X, U of G04."""
        return self._positive(word, self._decimal(word, METRIC_DIGITS, "s"))

    def milliseconds(self, word: Word) -> float:
        """P of G04 in seconds."""
        return self._positive(word, self.integer(word)) / 1000.0

    def integer(self, word: Word, number: str = "PS0007") -> int:
        """A plain integer; with a point the alarm `number` is raised."""
        if word.has_point:
            raise alarm(number, str(word), self.place(word), valid="" if number != "PS0007" else "an integer")
        return int(word.text)

    def natural(self, word: Word) -> int:
        """A plain integer without sign. Raises PS0006, PS0007."""
        if word.text.startswith("-"):
            raise alarm("PS0006", str(word), self.place(word))
        return self.integer(word)

    def _positive(self, word: Word, value: float) -> float:
        if value < 0.0:
            raise alarm("PS0006", str(word), self.place(word))
        return value

    def _decimal(self, word: Word, digits: int, unit: str) -> float:
        if word.has_point or self.calculator:
            return truncated(word.text, digits)
        value = float(word.text) / 10.0**digits
        if value:
            found = f"{word}, read as {value:g} {unit}"
            self.warn(Alarm(number="HT9104", found=found, span=self.place(word)))
        return value
