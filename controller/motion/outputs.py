"""The output signals that a state of the machine gives (signals.py has their table and clauses)."""

from collections.abc import Callable, Sequence

from controller.motion.reference import POINTS, References
from controller.tables.machine_data import MachineData
from controller.tables.signals import AxisInput, Inputs

_HALF_INCREMENT = 0.0005
"""[mm | deg] a slide that stands on the end of a switch is within"""


def output_signals(
    machine: MachineData,
    inputs: Inputs,
    references: References,
    *,
    slides: Sequence[float],
    moves: Callable[[int], bool],
) -> dict[str, bool]:
    """Name -> level of every output signal.

    `slides` are the machine coordinates (axes,) [mm | deg], `moves` says of a column whether its slide moves.
    """
    levels: dict[str, bool] = {}
    mirrored, detached = inputs.columns(AxisInput.MIRROR), inputs.columns(AxisInput.DETACH)
    for k, axis in enumerate(machine.axes):
        moving, point = moves(k), references.reached.get(k)
        levels[f"INP{axis.letter}"] = not moving
        levels[f"MV{axis.letter}"] = moving
        for number in range(1, POINTS + 1):
            levels[f"ZP{number if number > 1 else ''}{axis.letter}"] = point == number and not moving
        levels[f"MMI{axis.letter}"] = k in mirrored
        levels[f"MDTCH{axis.letter}"] = k in detached
    for switch in machine.position_switches:
        low, high = switch.lower - _HALF_INCREMENT, switch.upper + _HALF_INCREMENT
        levels[f"PSW{switch.number:02d}"] = low < slides[switch.axis] < high
    return levels
