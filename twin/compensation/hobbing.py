"""A hobbing program with a table of corrections against the work angle put before its gear box.

With O1 at e∠(φ + C) the hob comes off the gear's axis by −e∠(φ + C). X takes back the part along X. The part
across is a shift of the generating rack by −e sin(φ + C): the gear that rolls on it without slip stands so
much behind on its reference circle, and C turns by −e sin(φ + C) / r.
"""

import math

from controller.commands import Couple
from controller.dry_run import dry_run
from controller.language.source import Program
from controller.observed import Observed
from twin.compensation.correction import SAG_MM
from twin.errors import InputError, Place
from twin.presets import ControllerSettings
from twin.probing.circle import Circle

FEWEST = 12
"""points of a table"""


def first_gear_box(program: Program, settings: ControllerSettings) -> Observed | None:
    """Where the program engages a gear box first; None where it never does. Raises InputError for a program
    that ends in an alarm."""
    found: list[Observed] = []

    def see(seen: Observed) -> None:
        if isinstance(seen.command, Couple) and not found:
            found.append(seen)

    run = dry_run(
        program,
        settings.parameters,
        settings.offsets,
        settings.signals,
        events=settings.events,
        observe=see,
    )
    if run.alarms:
        raise InputError(f"the program to be compensated ends in an alarm: {run.alarms[0]}")
    return found[0] if found else None


def with_table(program: Program, engaged: Observed, circle: Circle, *, radius: float, title: str) -> str:
    """The program with its table, in front of the block that engages the gear box.

    `radius` [mm]: of the circle on which the gear rolls. Raises InputError where that block stands in
    another file.
    """
    span = engaged.span
    if span.line is None or span.file != program.span(0).file:
        raise InputError(
            "cannot compensate a gear box that a subprogram engages",
            place=Place(file=span.file, line=span.line),
            remedy="G81 in the main program",
        )
    lines = list(program.lines)
    lines[span.line - 1 : span.line - 1] = [f"({title})", *table_blocks(circle, radius)]
    return "\n".join([*lines, ""])


def table_blocks(circle: Circle, radius: float) -> list[str]:
    """Blocks that fill the table and bring it into force."""
    count = points_of(circle)
    blocks = [f"G10 L60 Q{count} ;"]
    for k in range(count):
        along, turn = corrections(circle, 2.0 * math.pi * k / count, radius)
        blocks.append(f"G10 L60 P{k + 1} X{2.0 * along + 0.0:.3f} C{math.degrees(turn) + 0.0:.3f} ;")
    return [*blocks, "G10 L61 ;"]


def corrections(circle: Circle, c: float, radius: float) -> tuple[float, float]:
    """What X [mm, radius] and C [rad] need at an angle of C [rad]."""
    turned = circle.phase + c
    return circle.eccentricity * math.cos(turned), -circle.eccentricity * math.sin(turned) / radius


def points_of(circle: Circle) -> int:
    """So many that straight lines between them stay within SAG_MM."""
    if circle.eccentricity <= SAG_MM:
        return FEWEST
    return max(FEWEST, math.ceil(math.pi / math.acos(1.0 - SAG_MM / circle.eccentricity)))
