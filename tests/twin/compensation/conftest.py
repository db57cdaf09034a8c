"""A small gear to be probed and ground, as files."""

import math
from pathlib import Path

import pytest

MACRO = Path(__file__).parents[3] / "scenes" / "ground_spur_probed" / "O9810.nc"

JOB = """
[machine]
setup = "{setup}"
parameters = {{ {parameters} }}
[work]
profile = [[0.0, 20.0], [-10.0, 20.0], [-10.0, {tip}], [-16.0, {tip}]]
bore_mm = 8.0
[work.gear]
stock_per_flank_mm = 0.15
gap_phase_deg = 7.0
[tool]
kind = "gap_wheel"
outside_diameter_mm = 40.0
chord_um = 0.1
[probe]
program = "probing.nc"
reach_mm = 40.0
repeatability_um = {repeatability}
[program]
file = "program.nc"
[nominal]
kind = "gear"
number_of_teeth = 15
normal_module_mm = 2.0
helix_angle_deg = {helix}
profile_shift = 0.3
face_width_mm = 6.0
[faults]
work_eccentricity_mm = 0.05
work_eccentricity_phase_deg = {phase}
"""
PROBING = """%
O0002
{home}
G54 G98 G00 T0909
G00 X60. Z-5.
G65 P9810 A8. D20. Q0.4 R0.4 F60.
G28 U0
M30
%
"""
PROGRAM = """%
O0001
{home}
G54 G98 G00 X60. Z20.
S3000 M03
#1=0
WHILE [#1 LT 15] DO1
#2=-7.-#1*24.
G00 C[#2-{twist}*20.]
G00 X{root}
G01 Z-36. C[#2+{twist}*36.] F3000.
G00 X60.
G00 Z20.
#1=#1+1
END1
M05
M30
%
"""


@pytest.fixture
def gear_job(tmp_path):
    """Writes the job, by helix angle, phase of the eccentricity, set-up and repeatability of the probe."""

    def write(helix=0.0, phase=70.0, setup="tilted", repeatability=0.0):
        pitch = 15 * 2.0 / math.cos(math.radians(helix))
        root = pitch + 2 * 2.0 * (0.3 - 1.25)
        tip = pitch + 2 * 2.0 * 1.3
        twist = math.degrees(2 * math.tan(math.radians(helix)) / pitch)
        tilted = setup == "tilted"
        folder = tmp_path / "gear"
        folder.mkdir()
        (folder / "O9810.nc").write_text(MACRO.read_text())
        home = ("G28 V0\n" if tilted else "") + "G28 U0 W0\nG28 H0"
        parameters = '"8200#0" = 1, "9001" = 5' if tilted else '"9001" = 3'
        (folder / "job.toml").write_text(
            JOB.format(
                helix=helix,
                phase=phase,
                setup=setup,
                parameters=parameters,
                tip=tip,
                repeatability=repeatability,
            )
        )
        (folder / "probing.nc").write_text(PROBING.format(home=home))
        (folder / "program.nc").write_text(
            PROGRAM.format(home=home, twist=f"{twist:.9f}", root=f"{root:.4f}")
        )
        return folder

    return write
