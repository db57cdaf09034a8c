"""A check as a process engineer reads it: what is wrong first, then tables."""

import heapq
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path

from controller.motion.registers import TURN
from twin.cli.check_result import CheckResult

_LONGEST = 5
"""blocks to list"""
_TEXT_WIDTH = 60
"""[characters] of a block's text"""
_SHORTEST_S = 0.0005
"""what rounds to no time is no long block"""


def as_text(result: CheckResult) -> list[str]:
    """Lines for a terminal, without colours."""
    run = result.run
    lines = [str(one) for one in (*run.warnings, *result.advice, *run.alarms)]
    if result.read_on:
        lines += ["behind it, read line by line, not run:", *(f"  {one}" for one in result.read_on)]
    for section, text_last in (
        (_travel, False),
        (_rotary, False),
        (_sync, True),
        (_blocks, True),
        (_end, False),
    ):
        rows = list(section(result))
        if len(rows) > 1:
            lines += ["", *_aligned(rows, text_last=text_last)]
    return [*lines, "", *_summary(result)]


def _aligned(rows: Sequence[Sequence[str]], *, text_last: bool) -> list[str]:
    """Columns side by side, headers over them: names and texts to the left, figures to the right."""
    last = len(rows[0]) - 1
    widths = [max(len(row[k]) for row in rows) for k in range(last + 1)]
    lines = []
    for row in rows:
        cells = [
            cell.ljust(width) if k == 0 or (text_last and k == last) else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
    return lines


def _travel(result: CheckResult) -> Iterator[tuple[str, ...]]:
    yield "travel, mm", "program from", "to", "slide from", "to", "mm/min", "limit", "mm/s²", "limit"
    for letter, extent in result.run.extents.items():
        if letter in result.run.turns:
            continue
        peak = result.run.peaks[letter]
        ends = (f"{value:.3f}" for value in (*extent.absolute, *extent.machine))
        speeds = (f"{value:.0f}" for value in (peak.speed, peak.speed_limit))
        rates = (f"{value:.0f}" for value in (peak.acceleration, peak.acceleration_limit))
        yield f"  {letter}", *ends, *speeds, *rates


def _rotary(result: CheckResult) -> Iterator[tuple[str, ...]]:
    yield "rotary", "turns", "rpm", "limit", "rpm/s", "limit"
    for letter, turns in result.run.turns.items():
        peak = result.run.peaks[letter]
        figures = (
            f"{value:.1f}"
            for value in (peak.speed, peak.speed_limit, peak.acceleration, peak.acceleration_limit)
        )
        yield f"  {letter}", f"{turns + 0.0:.3f}", *figures


def _sync(result: CheckResult) -> Iterator[tuple[str, ...]]:
    yield "gear box on", "from s", "to s", "lines"
    for one in result.run.sync:
        last = "end" if one.last_line is None else str(one.last_line)
        yield f"  {one.kind.value}", f"{one.start_s:.3f}", f"{one.end_s:.3f}", f"{one.first_line} to {last}"


def _blocks(result: CheckResult) -> Iterator[tuple[str, ...]]:
    """The blocks that take the most time, all their runs together."""
    yield "longest blocks", "s", "runs", ""
    blocks = result.run.blocks
    seconds: dict[int, float] = defaultdict(float)
    lines: list[int] = list(blocks.line)
    for line, duration in zip(lines, blocks.duration_s, strict=True):
        seconds[line] += duration
    longest = heapq.nlargest(_LONGEST, seconds, key=lambda line: seconds[line])
    runs = Counter(line for line in lines if line in longest)
    for line in longest:
        if seconds[line] >= _SHORTEST_S:
            name, text = _source(result, line)
            yield name, f"{seconds[line]:.3f}", str(runs[line]), text


def _source(result: CheckResult, line: int) -> tuple[str, str]:
    """Name and text of a block; line 0 is the operator's keyboard."""
    if line == 0:
        return "  MDI", ""
    block = result.program.ref(line - 1)
    file = "" if block.file == result.program.file else f"{Path(block.file).name} "
    return f"  {file}line {block.line}", block.text[:_TEXT_WIDTH]


def _end(result: CheckResult) -> Iterator[tuple[str, ...]]:
    run = result.run
    yield "at the end, mm | deg", *run.absolute
    for name, values in (("absolute", run.absolute), ("relative", run.relative), ("machine", run.machine)):
        # what rounds up to a whole turn stands at its beginning
        shown = (0.0 if k in run.turns and value > TURN - 5e-4 else value for k, value in values.items())
        yield f"  {name}", *(f"{value + 0.0:.3f}" for value in shown)


def _summary(result: CheckResult) -> Iterator[str]:
    run = result.run
    alarms, warnings = len(run.alarms) + len(result.read_on), len(result.warnings)
    notes = len(run.warnings) + len(result.advice) - warnings
    minutes, seconds = divmod(run.cycle_time_s, 60.0)
    clock = f" ({minutes:.0f} min {seconds:.0f} s)" if minutes else ""
    if run.in_sync_at_end:
        yield "the gear box is still on at the end"
    said = f"{alarms} alarm(s), {warnings} warning(s)" + (f", {notes} note(s)" if notes else "")
    yield f"cycle time {run.cycle_time_s:.1f} s{clock}; {said}"
