"""Numbers of a block become lengths, angles, times, integers (rulings, section 1, Numbers; parameter 3401#0).

A number with a point, or with DPI = 1, counts units; one without a point and DPI = 0 counts least increments
(0.001 mm, 0.0001 inch, 0.001 deg) and is warned about. Finer than one increment is truncated.
"""

from collections.abc import Callable
from dataclasses import dataclass

from controller.language.lexer import Word
from controller.laws.gearbox import MM_PER_INCH
from controller.span import Span
from controller.tables.alarms import Alarm, alarm

METRIC_DIGITS = 3
INCH_DIGITS = 4
WHOLE = 1e-6
"""what an expression may be away from a whole number"""


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
        return self._decimal(word, digits, "in" if self.inch else "mm") * self._length_unit

    def angle(self, word: Word) -> float:
        """[deg]"""
        return self._decimal(word, METRIC_DIGITS, "deg")

    def argument(self, word: Word) -> float:
        """An argument of a macro by the same rule, in whatever unit the macro takes it; not cut off."""
        if word.value is not None:
            return word.value
        if word.has_point or self.calculator:
            return float(word.text)
        return self._decimal(word, INCH_DIGITS if self.inch else METRIC_DIGITS, "")

    def pitch(self, word: Word) -> float:
        """Q of G81: module [mm] or, in inches, diametral pitch [1/inch]."""
        return self._decimal(word, METRIC_DIGITS, "1/in" if self.inch else "mm")

    def feed(self, word: Word, *, per_revolution: bool) -> float:
        """F in programmed units: mm/min or inch/min, mm or inch per revolution. Raises PS0006."""
        if word.negative:
            raise alarm("PS0006", str(word), self.place(word))
        if word.value is not None:
            return word.value
        value = float(word.text)
        counted = per_revolution and not self.calculator and not word.has_point
        return value * (0.0001 if self.inch else 0.01) if counted else value

    def seconds(self, word: Word) -> float:
        """X, U of G04."""
        return self._positive(word, self._decimal(word, METRIC_DIGITS, "s"))

    def milliseconds(self, word: Word) -> float:
        """P of G04 in seconds."""
        return self._positive(word, float(self.integer(word))) / 1000.0

    def counted_length(self, word: Word) -> float:
        """P, Q of G74 to G76 [mm]: without a point always in least increments, whatever DPI says."""
        return self._counted(word, INCH_DIGITS if self.inch else METRIC_DIGITS) * self._length_unit

    def counted_angle(self, word: Word) -> float:
        """Q of G32, G92, G76 [deg]: without a point always in 0.001 deg, whatever DPI says."""
        return self._counted(word, METRIC_DIGITS)

    def integer(self, word: Word, number: str = "PS0007") -> int:
        """A plain integer; with a point, or where an expression is none, the alarm `number` is raised."""
        whole = word.value is None or abs(word.value - round(word.value)) < WHOLE
        if word.has_point or not whole:
            raise alarm(number, str(word), self.place(word), valid="" if number != "PS0007" else "an integer")
        return int(word.text) if word.value is None else round(word.value)

    def natural(self, word: Word) -> int:
        """A plain integer without sign. Raises PS0006, PS0007."""
        if word.negative:
            raise alarm("PS0006", str(word), self.place(word))
        return self.integer(word)

    def whole(self, word: Word) -> int:
        """An integer that may be written with a point and nothing but zeros behind it: R of G73."""
        value = float(word.text) if word.value is None else word.value
        if abs(value - round(value)) > WHOLE:
            raise alarm("PS0007", str(word), self.place(word), valid="an integer")
        return round(value)

    def nearest(self, word: Word) -> Word:
        """S: the result of an expression rounded to a whole number; a number as it is."""
        return word if word.value is None else word._replace(value=float(round(word.value)))

    @property
    def _length_unit(self) -> float:
        return MM_PER_INCH if self.inch else 1.0

    def _positive(self, word: Word, value: float) -> float:
        if value < 0.0:
            raise alarm("PS0006", str(word), self.place(word))
        return value

    def _counted(self, word: Word, digits: int) -> float:
        if word.value is not None:
            return word.value
        return truncated(word.text, digits) if word.has_point else float(word.text) / 10.0**digits

    def _decimal(self, word: Word, digits: int, unit: str) -> float:
        if word.value is not None:
            return round(word.value, digits)  # expressions are rounded to the increment, not cut off
        if word.has_point or self.calculator:
            return truncated(word.text, digits)
        value = float(word.text) / 10.0**digits
        if value:
            found = f"{word}, read as {value:g} {unit}"
            self.warn(Alarm(number="HT9104", found=found, span=self.place(word)))
        return value
