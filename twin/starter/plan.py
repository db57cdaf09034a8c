"""What a draft consists of, and the numbers every draft needs."""

import math
from dataclasses import dataclass

from controller.tables.parameters import delivered


@dataclass(frozen=True, slots=True, kw_only=True)
class Draft:
    """A job folder that is not written yet."""

    job: str
    """text of job.toml"""
    program: str
    """text of program.nc"""
    summary: str
    """one line for the user"""


def highest_speeds() -> tuple[float, float]:
    """Of work and tool spindle [rpm] as the machine is delivered (parameter 3772)."""
    parameters = delivered("hobbing")
    return parameters.number(3772, "C"), parameters.number(3772, "Y")


def spindle_speed(cutting_speed: float, diameter: float, highest: float) -> int:
    """S [rpm] for a cutting speed [m/min] at a diameter [mm], down to full tens, at most `highest`."""
    rpm = min(1000.0 * cutting_speed / (math.pi * diameter), highest)
    return max(10 * int(rpm // 10), 1)


def up(value: float, step: float) -> float:
    """The next multiple of `step` that is not below `value`."""
    return step * math.ceil(value / step - 1e-9)


def word(address: str, value: float, digits: int = 3) -> str:
    """An NC word with a decimal point and no needless zeros: X37.567, Z-46."""
    text = f"{value:.{digits}f}".rstrip("0")
    return f"{address}{'0.' if text in ('-0.', '0.') else text}"


def toml_number(value: float) -> str:
    """A number as job.toml takes it: 2.0, 46.567."""
    text = f"{value:.6f}".rstrip("0")
    return text + "0" if text.endswith(".") else text


def program_text(title: str, rows: tuple[tuple[str, str], ...]) -> str:
    """A program of (block, why) rows, numbered, with the reasons as annotations in one column."""
    width = max(len(block) for block, _ in rows)
    blocks = [
        f"N{10 * (k + 1):04d} {block:<{width}} ;  {why}".rstrip() for k, (block, why) in enumerate(rows)
    ]
    return "\n".join(["%", f"O0001 ({title})", *blocks, "%", ""])
