"""G90, G92, G94: one cut there and the way back to the start point."""

from controller.language.cycles.strokes import Point, Stroke


def turning(start: Point, end: Point, taper: float) -> list[Stroke]:
    """G90: X at rapid, the cut along Z, X at feed, Z at rapid; `taper` is X of its start minus its end."""
    return [
        Stroke(end=(start[0], end[1] + taper), rapid=True),
        Stroke(end=end),
        Stroke(end=(end[0], start[1])),
        Stroke(end=start, rapid=True),
    ]


def facing(start: Point, end: Point, taper: float) -> list[Stroke]:
    """G94: Z at rapid, the cut along X, Z at feed, X at rapid; `taper` is Z of its start minus its end."""
    return [
        Stroke(end=(end[0] + taper, start[1]), rapid=True),
        Stroke(end=end),
        Stroke(end=(start[0], end[1])),
        Stroke(end=start, rapid=True),
    ]


def threading(start: Point, end: Point, taper: float, lead: float, start_angle: float) -> list[Stroke]:
    """G92: X at rapid, the thread along Z, X and Z back at rapid."""
    return [
        Stroke(end=(start[0], end[1] + taper), rapid=True),
        Stroke(end=end, lead=lead, start_angle=start_angle),
        Stroke(end=(end[0], start[1]), rapid=True),
        Stroke(end=start, rapid=True),
    ]
