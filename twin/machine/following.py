"""What both machines share: the follow law, and what a chunk must be."""

from typing import TypeVar

import numpy as np

from controller.clock import Chunk, Floats, Follow

Value = TypeVar("Value", float, Floats)


def follow(coupling: Follow, command: Value, master: Value) -> Value:
    """Setpoint [deg] of a slave whose own command is `command`, from its master's actual position.

    One rounding for the product and one for the quotient: no drift over any number of turns.
    """
    return command + (coupling.offset + coupling.numerator * master / coupling.denominator)


def couple(chunk: Chunk) -> Floats:
    """(n, axes) setpoints with the couplings applied to masters that follow exactly."""
    setpoint = chunk.setpoint.copy()
    for c in chunk.couplings:
        setpoint[:, c.slave] = follow(c, setpoint[:, c.slave], setpoint[:, c.master])
    return setpoint


def require_chunk(chunk: Chunk, axes: int, tick: int) -> None:
    """Raise ValueError where the controller broke the contract of `controller.clock`."""
    if chunk.setpoint.ndim != 2 or chunk.setpoint.shape[1] != axes:
        raise ValueError(f"setpoint: expected (n, {axes}), got {chunk.setpoint.shape}")
    if chunk.first_tick != tick:
        raise ValueError(f"chunk starts at tick {chunk.first_tick}, the machine stands at {tick}")
    if not np.isfinite(chunk.setpoint).all():
        row, column = np.argwhere(~np.isfinite(chunk.setpoint))[0]
        raise ValueError(f"setpoint of axis {column} is not finite at tick {tick + row}")
    masters = {c.master for c in chunk.couplings}
    slaves = [c.slave for c in chunk.couplings]
    if len(set(slaves)) != len(slaves) or masters & set(slaves):
        raise ValueError(f"couplings {chunk.couplings}: an axis follows twice, or follows a follower")
