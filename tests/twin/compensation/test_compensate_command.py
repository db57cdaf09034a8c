"""`hobtwin compensate` from the command line: the whole walk on a small gear, and all that may stop it."""

import json
import math

import pytest

from twin.cli import main

E = 0.05


def set_by_hand(folder, *touches):
    """A cycle that touches nothing and leaves these radii and angles."""
    lines = [f"#501={len(touches)}"]
    for k, (radius, angle) in enumerate(touches, start=1):
        lines += [f"#{600 + k}={radius:.6f}", f"#{700 + k}={angle:.6f}"]
    (folder / "probing.nc").write_text("\n".join(["O0002", *lines, "G04 X0.1", "M30", ""]))


def touched(e, phase, count=8, radius=9.9, form=0.0):
    angles = [360.0 * k / count for k in range(count)]
    return [
        (
            radius + e * math.cos(math.radians(phase + angle)) + form / 2 * math.cos(3 * math.radians(angle)),
            angle,
        )
        for angle in angles
    ]


def test_the_whole_walk(gear_job, tmp_path, capsys):
    """Uncompensated F_p = 2e / cos α_M and F_r = 2e but for 15 teeth, that miss the crest by up to 12°;
    compensated at most 5 % of it. The blank has 0.15 mm to give, which e alone must not use up."""
    out = tmp_path / "out"
    folder = gear_job(phase=70.0)
    code = main(["compensate", str(folder), "--ideal", "--cell-mm", "0.8", "--quiet", "--out", str(out)])
    said = capsys.readouterr().out
    assert code in (0, 1)
    assert "phi 70.00" in said
    found = json.loads((out / "compensation.json").read_text())
    assert found["fits"]["geometric"]["e_mm"] == pytest.approx(E, abs=1e-6)
    alpha = math.acos(30.0 * math.cos(math.radians(20.0)) / 31.2)
    before, after = found["before_um"], found["after_um"]
    for side in ("left", "right"):
        pitch = before[f"cumulative_pitch_{side}"]
        assert pitch == pytest.approx(2e3 * E / math.cos(alpha), rel=0.02)
        assert after[f"cumulative_pitch_{side}"] < 0.05 * pitch
        # the normal of a flank point stands askew to the shift at one tooth or the other
        assert before[f"removal_{side}_least"] == pytest.approx(100.0, abs=2.0)
        assert before[f"removal_{side}_most"] == pytest.approx(200.0, abs=2.0)
        assert after[f"removal_{side}_least"] == pytest.approx(150.0, abs=1.5)
        assert after[f"removal_{side}_most"] == pytest.approx(150.0, abs=1.5)
    assert before["runout"] == pytest.approx(2e3 * E, rel=0.02)
    assert after["runout"] < 0.05 * before["runout"]
    page = (out / "compensation.html").read_text()
    assert page.count("<svg") == 8
    assert len(set(_ids(page))) == len(_ids(page))
    assert main(["check", str(out / "compensated")]) == 0
    beside = sorted(path.name for path in (out / "compensated").iterdir())
    assert beside == ["O9810.nc", "compensated.nc", "job.toml", "probing.nc"]
    for name in ("before/report.html", "after/report.html", "provenance.json"):
        assert (out / name).is_file()


def _ids(page):
    return [part.split('"')[0] for part in page.split('id="')[1:]]


def refused(capsys, folder, out, *options):
    """Exit code and message; nothing has been written."""
    code = main(["compensate", str(folder), "--ideal", "--quiet", "--out", str(out), *options])
    assert not out.exists()
    return code, capsys.readouterr().err


@pytest.mark.parametrize(
    ("touches", "words"),
    [
        ([], "0 touched point(s) make no circle"),
        (touched(E, 70.0)[:2], "2 touched point(s) make no circle"),
        ([(10.0, 0.0), (5.0, 0.0), (2.0, 0.0), (7.0, 180.0)], "4 touched points lie on one line"),
        (touched(E, 70.0, form=0.03), "out of round by 30.0 µm, its eccentricity is 50.0 µm"),
        (touched(14.0, 70.0, radius=20.0, count=3), "the eccentricity measured is"),
    ],
)
def test_touches_that_cannot_be_compensated(gear_job, tmp_path, capsys, touches, words):
    folder = gear_job()
    set_by_hand(folder, *touches)
    code, said = refused(capsys, folder, tmp_path / "out")
    assert code == 1
    assert words in said


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("#500=0", "left #501 = null"),
        ("#501=2.5", "left #501 = 2.5"),
        ("#501=1", "left touch 1 empty: #601 = null, #701 = null"),
    ],
)
def test_a_cycle_that_leaves_nothing_to_read(gear_job, tmp_path, capsys, lines, words):
    folder = gear_job()
    (folder / "probing.nc").write_text(f"O0002\n{lines}\nG04 X0.1\nM30\n")
    code, said = refused(capsys, folder, tmp_path / "out")
    assert code == 1
    assert words in said


@pytest.mark.parametrize(
    ("old", "new", "alarm", "figures"),
    [
        ("Z-5.", "Z20.", "MC3001", "touches made 0, last X, radius 9.6"),
        ("D20.", "D18.", "MC3002", "touches made 0, last X, radius 9.4"),
        ("A8.", "A2.", "MC3003", "touches made 0"),
        ("Z-5.", "Z-14.", "HT9031", "no reference band"),
    ],
)
def test_a_cycle_that_ends_in_an_alarm(gear_job, tmp_path, capsys, old, new, alarm, figures):
    folder = gear_job()
    cycle = folder / "probing.nc"
    cycle.write_text(cycle.read_text().replace(old, new))
    code, said = refused(capsys, folder, tmp_path / "out")
    assert code == 1
    assert alarm in said
    assert figures in said


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('[probe]\nprogram = "probing.nc"\nreach_mm = 40.0\nrepeatability_um = 0.0\n', "", "no touch probe"),
        ('program = "probing.nc"\n', "", "names no probing cycle"),
        ('program = "probing.nc"', 'program = "other.nc"', "no probing cycle 'other.nc'"),
        ("repeatability_um = 0.0", "tool = 0", "probe.tool"),
        ("repeatability_um = 0.0", "stiffness_n_per_mm = 0", "probe.stiffness_n_per_mm"),
        ("repeatability_um = 0.0", "trigger_force_n = 5", "the signal comes after 5 mm"),
        ("repeatability_um = 0.0", "radius = 2", "unknown key 'radius' in [probe]"),
        ("[0.0, 20.0], [-10.0, 20.0], [-10.0, ", "[0.0, ", "no band that could be probed"),
    ],
)
def test_a_job_that_cannot_be_probed(gear_job, tmp_path, capsys, old, new, words):
    folder = gear_job()
    job = folder / "job.toml"
    assert old in job.read_text()
    job.write_text(job.read_text().replace(old, new))
    code, said = refused(capsys, folder, tmp_path / "out")
    assert code == 2
    assert words in said


def test_an_existing_folder_is_not_written_over(gear_job, tmp_path, capsys):
    out = tmp_path / "mine"
    out.mkdir()
    (out / "notes.txt").write_text("mine")
    assert main(["compensate", str(gear_job()), "--quiet", "--out", str(out)]) == 2
    assert "not a result of hobtwin" in capsys.readouterr().err
    assert [path.name for path in out.iterdir()] == ["notes.txt"]
