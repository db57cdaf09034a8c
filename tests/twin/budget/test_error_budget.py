"""The budget of a short gear: every source alone by its closed form, all together, and what is refused."""

import json
import math
import shutil
from pathlib import Path

import pytest

from twin.cli import main

SCENES = Path(__file__).parents[3] / "scenes"
ALPHA = math.radians(20.0)


@pytest.fixture
def job(tmp_path):
    """A gear 5 mm wide, cut at 1 mm a turn, with an eccentric and a tilted blank and a long hob thread."""
    folder = tmp_path / "job"
    shutil.copytree(SCENES / "spur_m2_z20", folder)
    text = (folder / "job.toml").read_text(encoding="utf-8")
    text = text.replace("length_mm = 20.0", "length_mm = 5.0")
    text += (
        "[faults]\nwork_eccentricity_mm = 0.02\nwork_eccentricity_phase_deg = 9.0\nwork_tilt_deg = 0.05\n"
        "hob_lead_error_um_per_turn = 5.0\nhob_runout_mm = 0.0\n"
    )
    (folder / "job.toml").write_text(text, encoding="utf-8")
    program = (folder / "program.nc").read_text(encoding="utf-8")
    program = program.replace("Z20.", "Z5.").replace("Z-38. F2.", "Z-8. F1.")
    (folder / "program.nc").write_text(program, encoding="utf-8")
    return folder


def test_each_source_shows_what_it_does_alone(job, tmp_path, capsys):
    out = tmp_path / "budget"
    assert main(["budget", str(job), "--out", str(out), "--quiet"]) == 0
    said = capsys.readouterr().out
    budget = json.loads((out / "budget.json").read_text(encoding="utf-8"))
    sources = {source["name"]: source for source in budget["sources"]}
    # a fault of nought is none
    assert "faults.hob_runout_mm" not in sources
    off = sources["faults.work_eccentricity_mm"]["values_um"]
    assert off["cumulative_pitch"] == pytest.approx(2 * 20.0 / math.cos(ALPHA), rel=0.02)
    assert off["runout"] == pytest.approx(2 * 20.0, rel=0.02)
    assert off["single_pitch"] == pytest.approx(2 * 20.0 * math.sin(math.pi / 20) / math.cos(ALPHA), rel=0.02)
    assert off["helix_slope"] < 0.2
    tilt = sources["faults.work_tilt_deg"]["values_um"]
    # 5 % of the face are left out at each end
    assert tilt["helix_slope"] == pytest.approx(1e3 * 4.5 * math.tan(math.radians(0.05)), rel=0.05)
    lead = sources["faults.hob_lead_error_um_per_turn"]["values_um"]
    start, end = (math.sqrt(d**2 - 37.58770**2) / 2 for d in (37.640133, 44.0))
    length = 0.95 * (end - start)
    assert lead["profile_slope"] == pytest.approx(5.0 * length / (2 * math.pi), rel=0.05)
    assert lead["cumulative_pitch"] < 0.2
    # with drives as delivered, next to nothing beside the faults
    assert sources["drives"]["values_um"]["cumulative_pitch"] < 0.5
    together = budget["together"]["values_um"]
    assert together["cumulative_pitch"] > 0.9 * off["cumulative_pitch"]
    assert budget["sources"][0]["name"] == "faults.work_eccentricity_mm"
    assert "mend first: work clamped off centre" in said
    assert budget["tolerances_um"]["cumulative_pitch"] == 48
    page = (out / "budget.html").read_text(encoding="utf-8")
    assert page.count("<rect") == len(sources)
    assert "http" not in page


@pytest.fixture
def hexagon(tmp_path):
    """A hexagon 6 mm long, its blank clamped off centre and askew."""
    folder = tmp_path / "hexagon"
    shutil.copytree(SCENES / "hexagon_af17", folder)
    text = (folder / "job.toml").read_text(encoding="utf-8").replace("length_mm = 10.0", "length_mm = 6.0")
    text += "[faults]\nwork_eccentricity_mm = 0.02\nwork_tilt_deg = 0.05\n"
    (folder / "job.toml").write_text(text, encoding="utf-8")
    program = (folder / "program.nc").read_text(encoding="utf-8")
    (folder / "program.nc").write_text(program.replace("Z-12.", "Z-8."), encoding="utf-8")
    return folder


def test_each_source_shows_on_the_faces_of_a_polygon(hexagon, tmp_path, capsys):
    out = tmp_path / "budget"
    assert main(["budget", str(hexagon), "--out", str(out), "--quiet"]) == 0
    said = capsys.readouterr().out
    budget = json.loads((out / "budget.json").read_text(encoding="utf-8"))
    # a head of R 40 - 8.5 = 31.5 mm between the axes leaves a bow of which 0.9 of the width show 0.81
    assert budget["process_um"]["flatness"] == pytest.approx(0.81 * 13.04, abs=0.15)
    assert abs(budget["process_um"]["across_flats"]) < 0.01
    sources = {source["name"]: source["values_um"] for source in budget["sources"]}
    off = sources["faults.work_eccentricity_mm"]
    assert off["concentricity"] == pytest.approx(2 * 20.0, rel=0.01)
    assert abs(off["across_flats"]) < 0.2
    tilt = sources["faults.work_tilt_deg"]
    # 5 % of the length are left out at each end; the tilt goes towards a face, or up to 30° beside it
    most = 1e3 * 5.4 * math.tan(math.radians(0.05))
    assert 0.86 * most < tilt["lean"] < 1.01 * most
    assert abs(sources["drives"]["across_flats"]) < 0.5
    assert budget["sources"][0]["name"] == "faults.work_eccentricity_mm"
    assert "mend first: work clamped off centre" in said
    assert "both flanks" not in (out / "budget.html").read_text(encoding="utf-8")


def test_a_part_of_which_nothing_is_said_has_no_budget(hexagon, tmp_path, capsys):
    text = (hexagon / "job.toml").read_text(encoding="utf-8")
    (hexagon / "job.toml").write_text(text[: text.index("[nominal]")], encoding="utf-8")
    out = tmp_path / "out"
    assert main(["budget", str(hexagon), "--out", str(out), "--quiet"]) == 2
    assert "does not say what it makes" in capsys.readouterr().err
    assert not out.exists()


def test_a_machine_on_which_nothing_matters_is_told_so(job, tmp_path, capsys):
    text = (job / "job.toml").read_text(encoding="utf-8")
    (job / "job.toml").write_text(text[: text.index("[faults]")], encoding="utf-8")
    assert main(["budget", str(job), "--out", str(tmp_path / "out"), "--quiet"]) == 0
    said = capsys.readouterr().out
    assert "no source matters" in said
    assert "mend first" not in said


def test_where_already_the_ideal_part_is_no_gear_that_is_said(tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["budget", str(SCENES / "wrong_hand"), "--out", str(out), "--quiet"]) == 1
    assert "already on ideal axes there is no gear to measure" in capsys.readouterr().err
    assert not out.exists()
