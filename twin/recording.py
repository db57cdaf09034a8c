"""The recorded run: every axis over time, and where the tool was in the part's frame."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from twin.output.arrays import save_arrays
from twin.sync.spectrum import Spectrum

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockRef:
    """A program block that moved something."""

    file: str
    line: int
    """from 1"""
    text: str
    """the block as written"""


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedLoad:
    """What the cut did to the machine, sample by sample."""

    axes: Floats
    """(n, axes) mean force on each axis during the tick [N, N m], positive in its positive sense"""
    power_w: Floats
    """(n,)"""
    deflection_um: Floats
    """(n, 3) how far the mounts of tool and work give way, as motion of the tool in the work frame: X towards
    the tool, Z along the work axis"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Recording:
    """Axes over time in machine terms, and the tool in the part's frame.

    The part frame turns with the work: its Z is the work axis, its origin the front face, and at work
    angle 0 its +X points to the tool. Motion between two samples is linear in the axes.
    """

    time_s: Floats
    """(n,) uniform but for compressed idle spans"""
    axes: tuple[str, ...]
    """axis letters, in the order of the columns below"""
    setpoint: Floats
    """(n, axes) slide travel [mm, X in radius] and unwrapped degrees, from machine zero"""
    actual: Floats
    """(n, axes)"""
    block: NDArray[np.int32]
    """(n,) index into `blocks`"""
    blocks: tuple[BlockRef, ...]
    tool: NDArray[np.int16]
    """(n,) tool number, 0 = the mounted one"""
    sync: NDArray[np.bool_]
    """(n,) electronic gear box engaged"""
    sync_error_arcsec: Floats
    """(n,) of the gear box's slave, + = ahead in its positive sense; NaN out of sync"""
    sync_spectrum: Spectrum | None
    """None where the work never made a whole turn in sync at constant speed"""
    work_angle_deg: Floats
    """(n,) of the work spindle, unwrapped, + counter-clockwise seen from +Z"""
    tool_angle_deg: Floats
    """(n,) of the tool about `tool_axis`, unwrapped; at 0 its first edge points along `tool_zero`"""
    tool_centre_mm: Floats
    """(n, 3) in the turning part frame"""
    tool_axis: Floats
    """(n, 3) unit vector in the turning part frame, right-hand positive sense of rotation"""
    tool_zero: Floats
    """(n, 3) unit vector in the turning part frame, direction of tool angle 0"""
    load: RecordedLoad | None = None
    """of a run with cutting forces; `tool_centre_mm` is where they have pushed the tool"""

    def save(self, path: Path) -> None:
        """Write `recording.npz`: per axis letter `setpoint_X`, `actual_X`, …; the rest under its own name.

        `sync_order`, `sync_amplitude_arcsec`: lines of the error's spectrum, orders per turn of the work.
        With cutting forces `load_X`, …, `cutting_power_w` and `deflection_um` too.
        """
        columns: dict[str, NDArray] = {}
        for k, letter in enumerate(self.axes):
            columns[f"setpoint_{letter}"] = self.setpoint[:, k]
            columns[f"actual_{letter}"] = self.actual[:, k]
        columns |= {
            "time_s": self.time_s,
            "axes": np.array(self.axes),
            "block": self.block,
            "blocks": np.array([(b.file, str(b.line), b.text) for b in self.blocks], dtype=str).reshape(
                -1, 3
            ),
            "tool": self.tool,
            "sync": self.sync,
            "sync_error_arcsec": self.sync_error_arcsec,
            "sync_order": self.sync_spectrum.order if self.sync_spectrum else np.zeros(0),
            "sync_amplitude_arcsec": self.sync_spectrum.amplitude_arcsec
            if self.sync_spectrum
            else np.zeros(0),
            "work_angle_deg": self.work_angle_deg,
            "tool_angle_deg": self.tool_angle_deg,
            "tool_centre_mm": self.tool_centre_mm,
            "tool_axis": self.tool_axis,
            "tool_zero": self.tool_zero,
        }
        if self.load is not None:
            columns |= {f"load_{letter}": self.load.axes[:, k] for k, letter in enumerate(self.axes)}
            columns |= {"cutting_power_w": self.load.power_w, "deflection_um": self.load.deflection_um}
        save_arrays(path, columns)
