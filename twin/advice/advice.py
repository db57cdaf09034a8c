"""One piece of advice, with its place in the program."""

from dataclasses import dataclass

from controller.span import Span
from twin.advice.kinds import KINDS, Kind, Weight


@dataclass(frozen=True, slots=True, kw_only=True)
class Advice:
    """Something to mend before metal is cut. It reads like an alarm: number, text, found, remedy."""

    kind: Kind
    found: str
    """what was found, with its figures"""
    span: Span | None
    """the block that causes it; None = the job itself"""
    valid: str = ""
    """what mends it here; empty = the remedy of the table"""
    value: float | None = None
    """the figure that the advice rests on, in the unit `found` names"""

    @property
    def number(self) -> str:
        """HT9200 ff."""
        return self.kind.value

    @property
    def text(self) -> str:
        """The words of the table."""
        return KINDS[self.kind].text

    @property
    def weight(self) -> Weight:
        """Warning or note."""
        return KINDS[self.kind].weight

    @property
    def warns(self) -> bool:
        """Whether it is more than a note."""
        return self.weight is Weight.WARNING

    @property
    def remedy(self) -> str:
        """What mends it."""
        return self.valid or KINDS[self.kind].remedy

    def __str__(self) -> str:
        place = f"{self.span}: " if self.span else ""
        head = f"{place}{self.weight.value}[{self.number}]: {self.text}"
        return f"{head}: found {self.found}; valid: {self.remedy}"


def as_warning(advice: Advice) -> dict[str, str | int | None]:
    """Advice as plain values, in the form of `controller.tables.alarms.as_json`."""
    span = advice.span or Span(file="")
    return {
        "number": advice.number,
        "class": "program",
        "text": advice.text,
        "file": span.file or None,
        "line": span.line,
        "column": span.column,
        "found": advice.found,
        "remedy": advice.remedy,
    }


def advice_as_json(advice: Advice) -> dict[str, str | int | float | None]:
    """Advice as plain values, with its weight and its figure."""
    return {**as_warning(advice), "weight": advice.weight.value, "value": advice.value}
