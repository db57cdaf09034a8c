"""G22 and G23: stored stroke limit 2 on, with or without a new area, and off."""

from controller.commands import StrokeCheck
from controller.language.draft import Draft

G22, G23 = 220, 230
_BOUNDS = (("X", "I"), ("Y", "J"), ("Z", "K"))
"""upper and lower bound of a linear axis (Fanuc G22 X Y Z I J K)"""


def set_stroke_check(draft: Draft) -> None:
    """G22 (X Y Z I J K) and G23. Machine coordinates, X and I as the axis is programmed."""
    codes = draft.block.codes
    if G23 in codes:
        draft.commands.append(StrokeCheck(on=False))
    if G22 not in codes:
        return
    area: dict[int, tuple[float, float]] = {}
    linear = {axis.letter: k for k, axis in enumerate(draft.machine.axes) if not axis.rotary}
    for high, low in _BOUNDS:
        if high not in linear:
            continue  # its words are left over: PS0009
        upper, lower = draft.take(high), draft.take(low)
        if upper is None and lower is None:
            continue
        if upper is None or lower is None:
            one = upper or lower
            raise draft.alarm(
                "HT9012", f"only {one} of {high} and {low}", one, valid=f"both {high} and {low}"
            )
        column = linear[high]
        bounds = draft.axis_value(column, lower), draft.axis_value(column, upper)
        if bounds[0] >= bounds[1]:
            raise draft.alarm("HT9012", f"{low} not below {high}", lower, valid=f"{high} above {low}")
        area[column] = bounds
    draft.commands.append(StrokeCheck(on=True, area=area or None))
