"""A tailstock in the way: where it is touched first, by hand, and jobs that describe none."""

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest
from mounted import DELIVERED

from controller.clock import Chunk
from twin.errors import InputError
from twin.job import read_job
from twin.machine import Guarded, IdealMachine, Setup, TailstockMount, ToolMount, WorkMount, assemble
from twin.machine.silhouette import outlines
from twin.presets import cutters_of
from twin.setup import make_ready

# pyright: reportAttributeAccessIssue=false

CENTRE = TailstockMount(
    hole_diameter_mm=10.0,
    point_angle_deg=60.0,
    centre_diameter_mm=30.0,
    centre_length_mm=40.0,
    quill_diameter_mm=60.0,
    quill_length_mm=150.0,
)
WORK = WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0)
HOB = ToolMount(carrier_swivel_deg=90.0, radius_mm=35.0, length_mm=80.0, edges=12)
JOB = (Path(__file__).parents[3] / "scenes" / "spur_m2_z20" / "job.toml").read_text(encoding="utf-8")


def touched(z_mm: float, tailstock: TailstockMount | None = CENTRE) -> tuple[float, str]:
    """Radius [mm] of the tip at which a hob on its way to the axis at Z is stopped, and by what; 0 = none."""
    assembly = assemble(DELIVERED, Setup.HOBBING, work=WORK, tool=HOB, tailstock=tailstock)
    x = np.arange(80.0, 0.0, -0.01)
    setpoint = np.zeros((len(x), 4))
    setpoint[:, 0], setpoint[:, 1] = x - 200.0, z_mm - 300.0
    none = np.zeros(len(x))
    chunk = Chunk(
        first_tick=0,
        setpoint=setpoint,
        block=none.astype(np.int32),
        sync=none.astype(bool),
        tool=none.astype(np.int16),
    )
    feedback = Guarded(IdealMachine(4), assembly).advance(chunk)
    return (x[feedback.ticks - 1], feedback.alarms[0].found) if feedback.alarms else (0.0, "")


@pytest.mark.parametrize("z", [-2.0, -5.0])
def test_cone_is_touched_where_its_side_is_a_tangent_of_the_hob(z: float) -> None:
    """The hob's axis lies across, so its circle of 35 mm touches the line r = 5 mm + z tan 30° at 17.5 mm
    before its centre."""
    radius, said = touched(z)
    assert said == "cutter touches tailstock"
    slope = math.radians(30.0)
    expected = 5.0 + z * math.tan(slope) + 35.0 / math.cos(slope) - 35.0
    assert radius == pytest.approx(expected, abs=0.06)


@pytest.mark.parametrize(("z", "expected"), [(25.0, 15.0), (37.0, 23.50), (120.0, 30.0)])
def test_centre_and_quill_stand_behind_the_cone(z: float, expected: float) -> None:
    """The cone is 10 / tan 30° = 17.32 mm long, the centre behind it 40, the quill 150; at Z37 the hob
    meets the edge of the quill: 30 + √(35² − 20.32²) − 35."""
    radius, said = touched(z)
    assert said == "cutter touches tailstock"
    assert radius == pytest.approx(expected, abs=0.02)


def test_over_the_part_and_without_a_tailstock_nothing_is_in_the_way() -> None:
    assert touched(-40.0) == touched(-40.0, None)
    assert touched(60.0, None) == (0.0, "")


def test_it_is_drawn_and_moves_nothing() -> None:
    assembly = assemble(DELIVERED, Setup.HOBBING, work=WORK, tool=HOB, tailstock=CENTRE)
    shapes = [shape.points for shape in outlines(assembly, np.zeros(4)) if shape.body == "tailstock"]
    assert len(shapes) == 4
    assert min(points[:, 2].min() for points in shapes) == pytest.approx(0.0, abs=1e-4)
    plain = assemble(DELIVERED, Setup.HOBBING, work=WORK, tool=HOB)
    np.testing.assert_array_equal(assembly.inertia(), plain.inertia())
    assert assembly.picture_model().ngeom == plain.picture_model().ngeom + 8
    assert mujoco.mj_name2id(assembly.joints_alone, mujoco.mjtObj.mjOBJ_BODY, "tailstock") == -1


def job_with(folder: Path, tailstock: str) -> Path:
    text = f"{JOB[: JOB.index('[expect]')]}\n[setup]\ntailstock = {tailstock}\n"
    (folder / "job.toml").write_text(text, encoding="utf-8")
    (folder / "program.nc").write_text("O1\nM30\n", encoding="utf-8")
    return folder


def test_a_job_puts_it_before_its_bored_blank(tmp_path: Path) -> None:
    """The blank has a bore of 12 mm: the cone enters at 14."""
    job = read_job(job_with(tmp_path, "{}"))
    assembly = make_ready(job, cutters_of(job)).tools[0].assembly
    cone = next(s.points for s in outlines(assembly, np.zeros(4)) if s.body == "tailstock")
    at_face = cone[np.abs(cone[:, 2]) < 1e-4]
    assert np.hypot(at_face[:, 0], at_face[:, 1]).max() == pytest.approx(7.0, abs=0.02)


@pytest.mark.parametrize(
    ("tailstock", "said"),
    [
        ("{ hole_diameter_mm = 10.0 }", "hole_diameter_mm 10 is not above bore_mm 12"),
        ("{ hole_diameter_mm = 40.0 }", "centre_diameter_mm 30 is not above hole_diameter_mm 40"),
        ("{ hole_diameter_mm = 44.0, centre_diameter_mm = 50.0 }", "wider than the front face, 44 mm"),
        ("{ quill_diameter_mm = -1.0 }", "quill_diameter_mm"),
        ("{ point_angle_deg = 180.0 }", "point_angle_deg"),
        ("{ centre_length_mm = 1e-9 }", "centre_length_mm"),
        ("{ quill_length_mm = 1e9 }", "quill_length_mm"),
        ("{ hole_diameter_mm = 13.0, centre_diameter_mm = 13.01 }", "is not above hole_diameter_mm 13"),
        ("{ quil_length_mm = 10.0 }", "quill_length_mm"),
        ("3", "tailstock"),
    ],
)
def test_impossible_tailstocks_are_refused_at_their_line(tmp_path: Path, tailstock: str, said: str) -> None:
    with pytest.raises(InputError) as refusal:
        read_job(job_with(tmp_path, tailstock))
    assert said in str(refusal.value)
    assert "job.toml:" in str(refusal.value)
