"""A loaded run in figures, words and rows."""

import numpy as np
from numpy.typing import NDArray

from twin.load.lines import Line
from twin.load.loaded import LoadedRun

Floats = NDArray[np.float64]


def load_figures(loaded: LoadedRun | None) -> dict[str, object]:
    """`cutting_load` of inspection.json; nothing where no forces were asked for."""
    if loaded is None:
        return {}
    recording = loaded.session.recording
    load = recording.load
    forces = {
        f"largest_{letter}": float(np.abs(load.axes[:, k]).max(initial=0.0)) if load else 0.0
        for k, letter in enumerate(recording.axes)
    }
    line = loaded.line
    return {
        "cutting_load": {
            "settled": loaded.settled,
            "windows": loaded.windows,
            "rounds": loaded.rounds,
            "mean_rounds": loaded.mean_rounds,
            "moved_um": loaded.moved_um[-1] if loaded.moved_um else 0.0,
            "frequency_hz": loaded.frequency_hz,
            "stalled": loaded.stalled,
            "torque_limit": loaded.torque_limit,
            "mean_torque": loaded.mean_torque,
            "torque_line_hz": None if line is None else line.hz,
            "torque_line": None if line is None else line.amplitude,
            "k_c11": loaded.material.k_c11,
            "m_c": loaded.material.m_c,
            "tool_stiffness_n_per_um": loaded.stiffness.tool,
            "work_stiffness_n_per_um": loaded.stiffness.work,
            "removed_mm3": loaded.removed_mm3,
            "energy_j": loaded.energy_j,
            "mean_power_w": loaded.mean_power_w,
            "largest_power_w": float(loaded.load.power_w.max(initial=0.0)),
            "largest_deflection_um": float(np.linalg.norm(load.deflection_um, axis=1).max(initial=0.0))
            if load
            else 0.0,
            **forces,
        }
    }


def load_rows(loaded: LoadedRun | None, tool: str) -> list[tuple[str, str]]:
    """Figures and their names for the head of a sheet; `tool` is the letter of the tool spindle."""
    figures = load_figures(loaded).get("cutting_load")
    if loaded is None or not isinstance(figures, dict):
        return []
    line = loaded.line
    frequency = "" if loaded.frequency_hz is None else f", at {loaded.frequency_hz:.4g} Hz"
    return [
        ("k_{c1.1}, m_{c}", f"{loaded.material.k_c11:g} N/mm², {loaded.material.m_c:g}"),
        ("Energy", f"{figures['energy_j'] / 1e3:.3g} kJ for {figures['removed_mm3']:.4g} mm³"),
        ("Mean power", f"{figures['mean_power_w']:.0f} W"),
        ("Largest power", f"{figures['largest_power_w']:.0f} W"),
        (
            "Torque at the tool",
            f"{loaded.mean_torque:.3g} N m, at most {figures[f'largest_{tool}']:.3g} of the drive's "
            f"{loaded.torque_limit:.3g}",
        ),
        *([] if line is None else [("Largest line of the torque", _line(line))]),
        ("Give", f"up to {figures['largest_deflection_um']:.3g} µm: {loaded.stiffness.words()}"),
        (
            "Rounds",
            f"{loaded.mean_rounds:.2g} in a window, at most {loaded.rounds}; {loaded.windows} windows, "
            f"the last round moved {figures['moved_um']:.2g} µm{frequency}",
        ),
    ]


def _line(line: Line) -> str:
    return f"{line.amplitude:.3g} N m at {line.hz:.4g} Hz, {line.per_turn:.3g} a turn of the tool"


def load_words(loaded: LoadedRun) -> str:
    """The loaded run in one line."""
    figures = load_figures(loaded)["cutting_load"]
    if not isinstance(figures, dict) or not figures["removed_mm3"]:
        return "no metal removed"
    state = "settled" if loaded.settled else "not settled to the end"
    return (
        f"{state} in {loaded.windows} windows of at most {loaded.rounds} rounds; "
        f"{figures['removed_mm3']:.1f} mm³ for {figures['energy_j'] / 1e3:.3g} kJ; "
        f"power while cutting {figures['mean_power_w']:.0f} W, at most "
        f"{figures['largest_power_w']:.0f} W; give of up to {figures['largest_deflection_um']:.3g} µm "
        f"(rays {loaded.resolution_mm:.2g} mm apart)"
    )
