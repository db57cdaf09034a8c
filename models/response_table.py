"""`python -m models.response_table NAME`: measures every drive of a machine for the table of its README.

Each row is driven in MuJoCo with a hob Ø70 × 80 and a blank Ø44 × 20 mounted (`twin.machine.response`).
`off` is the largest distance of the measured frequency response from the loop's transfer function. The
picture beside it, `drives.svg`, shows the same.
"""

import sys
from pathlib import Path

from twin.machine import load_machine
from twin.machine.response import Response, delivered_responses
from twin.report.charts.drives import drives_file

BEGIN, END = "<!-- drives: python -m models.response_table -->", "<!-- end of drives -->"
HEAD = (
    "| axis | moved inertia | k_ff, k_a | −3 dB [Hz] | peak | phase at 10 Hz [°] | overshoot of a step "
    "| rise 10-90 % [ms] | unstable from Kv [1/s] | off |\n|---|---|---|---|---|---|---|---|---|---|"
)


def row(found: Response) -> str:
    """One line of the table."""
    drive = found.drive.drive
    edge = "—" if found.bandwidth_hz is None else f"{found.bandwidth_hz:.0f}"
    return (
        f"| {found.joint} | {found.inertia:.4g} {found.unit} "
        f"| {drive.velocity_feedforward:g}, {drive.acceleration_feedforward:g} | {edge} "
        f"| {found.peak:.3f} | {found.phase_at_10_hz_deg:.1f} | {found.overshoot:.1%} "
        f"| {found.rise_s * 1e3:.0f} "
        f"| {found.gain_limit:.0f} | {found.off:.0e} |"
    )


def main(name: str) -> None:
    """Write the table into the README of a model, and the picture beside it."""
    spec = load_machine(name)
    pairs = delivered_responses(spec)
    table = "\n".join([HEAD, *(row(found) for pair in pairs for found in pair)])
    path: Path = spec.folder / "README.md"
    text = path.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    path.write_text(f"{before}{BEGIN}\n{table}\n{END}{after}", encoding="utf-8")
    (spec.folder / "drives.svg").write_text(drives_file(pairs), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
