"""`hobtwin inspect` from the command line: exit codes, JSON, units, wrong units, chosen teeth, axis."""

import json

import numpy as np
import pytest
import trimesh

from twin.cli.main import main

GEAR = ("--teeth", "20", "--module", "2", "--class", "6")


@pytest.fixture(scope="module")
def folder(parts, tmp_path_factory):
    at = tmp_path_factory.mktemp("meshes")
    gear = parts.gear_mesh(teeth=20, module=2.0, bore=12.0, z_step=10.0, roll_step=0.1)
    hexagon = parts.polygon_mesh(across_flats=17.0, cutter_radius=40.0, inserts=3, sides=6)

    def save(name, mesh, scale=1.0):
        trimesh.Trimesh(np.asarray(mesh[0]) * scale, mesh[1], process=False).export(at / name)

    save("gear.stl", gear)
    save("gear.glb", gear, 1e-3)
    save("inch.stl", gear, 1 / 25.4)
    save("metre.stl", gear, 1e-3)
    save("micron.stl", gear, 1e3)
    save("askew.ply", parts.moved(gear, offset=(0.06, 0.08), tilt_deg=0.1, towards_deg=30.0, about_z=-10.0))
    save("hexagon.stl", hexagon)
    save("hexagon_inch.stl", hexagon, 1 / 25.4)
    save("concave.stl", parts.polygon_mesh(across_flats=17.0, cutter_radius=40.0, inserts=2, sides=6))
    vertices, faces = gear
    save("open.stl", (vertices, faces[3:]))
    save("doubled.stl", (vertices, np.concatenate([faces, faces[:7]])))
    save("inside_out.stl", (vertices, faces[:, ::-1]))
    save(
        "two.stl",
        (
            np.concatenate([vertices, vertices + np.array([90.0, 0.0, 0.0])]),
            np.concatenate([faces, faces + len(vertices)]),
        ),
    )
    broken = vertices.copy()
    broken[5, 2] = np.nan
    save("nan.ply", (broken, faces))
    save("huge.ply", (vertices * 1e30, faces))
    return at


@pytest.fixture
def run(folder, capsys):
    def call(mesh, *options):
        code = main(["inspect", str(folder / mesh), *options])
        said = capsys.readouterr()
        return code, said.out, said.err

    return call


@pytest.fixture
def values(run):
    def call(mesh, *options):
        code, out, _ = run(mesh, *options, "--format", "json")
        return code, json.loads(out)

    return call


def test_a_gear_in_json(values):
    code, found = values("gear.stl", *GEAR)
    assert code == 0
    assert (found["kind"], found["verdict"], found["number_of_teeth"]) == ("gear", "in", 20)
    left = found["flanks"]["left"]
    assert left["profile_total_um"] < 0.15
    assert {"filtered", "uncertainty", "profile_crowning_um", "profile_waviness", "profile"} <= left.keys()
    assert left["profile"][0]["points"] == 480
    assert "axis" not in found
    assert values("gear.glb", *GEAR)[1]["tip_diameter_mm"] == pytest.approx(44.0, abs=1e-4)


def test_a_gear_in_words(run):
    code, out, _ = run("gear.stl", *GEAR)
    assert code == 0
    assert "20 teeth, module 2.0000 mm, helix 0.0000° (spur)" in out
    assert "In tolerance." in out
    assert "-0.00" not in out


def test_nothing_named_measures_without_a_verdict(values):
    code, found = values("gear.stl")
    assert code == 0
    assert found["verdict"] == "not_graded"
    code, found = values("hexagon.stl")
    assert (code, found["kind"], found["flatness_class"]) == (0, "polygon", "H")


def test_out_of_tolerance_exits_1(values):
    code, found = values("concave.stl", "--sides", "6", "--across-flats", "17")
    assert (code, found["verdict"]) == (1, "out")


@pytest.mark.parametrize(
    ("mesh", "named", "words"),
    [
        ("inch.stl", GEAR, "a factor of 0.03937: the mesh seems to be in inches: try --units inch"),
        ("metre.stl", GEAR, "a factor of 0.001: the mesh seems to be in metres"),
        ("micron.stl", GEAR, "a factor of 1000: the mesh seems to be in micrometres"),
        ("hexagon_inch.stl", ("--sides", "6", "--across-flats", "17"), "seems to be in inches"),
        ("hexagon.stl", GEAR, "a part with 6 flat sides was found"),
        ("gear.stl", ("--teeth", "21", "--module", "2"), "20 teeth instead of 21"),
        ("two.stl", GEAR, "2 separate bodies"),
    ],
)
def test_not_the_named_part(values, mesh, named, words):
    code, found = values(mesh, *named)
    assert code == 1
    assert found["kind"] is None
    assert words in found["reason"]
    assert not {"flanks", "number_of_teeth", "across_flats_mm"} & found.keys()


def test_the_unit_that_was_tried(values):
    code, found = values("inch.stl", *GEAR, "--units", "inch")
    assert (code, found["verdict"]) == (0, "in")
    assert values("gear.glb", *GEAR, "--units", "mm")[1]["reason"].endswith("--units m")


def test_own_axis(values):
    code, found = values("askew.ply", *GEAR, "--find-axis")
    assert code == 0
    assert found["axis"]["datum"] == "bore"
    assert found["axis"]["offset_mm"] == pytest.approx(0.1, abs=1e-6)
    assert found["axis"]["tilt_deg"] == pytest.approx(0.1, abs=1e-6)
    code, askew = values("askew.ply", *GEAR)
    assert code == 1
    assert askew["runout_um"] > 150


def test_chosen_teeth_and_columns(values, tmp_path):
    code, found = values("gear.stl", *GEAR, "--teeth-to-measure", "2,1", "--csv", str(tmp_path / "t.csv"))
    assert code == 0
    assert [trace["tooth"] for trace in found["flanks"]["right"]["helix"]] == [1, 2]
    lines = (tmp_path / "t.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "flank,trace,tooth,position_mm,deviation_um,evaluated"
    assert len(lines) == 1 + 2 * 2 * 2 * 480
    _, every = values("gear.stl", *GEAR, "--teeth-to-measure", "all")
    assert len(every["flanks"]["left"]["profile"]) == 20


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        ("doubled.stl", "7 doubled faces were left out"),
        ("inside_out.stl", "the mesh came inside out and was turned"),
    ],
)
def test_mended_and_said(values, mesh, words):
    code, found = values(mesh, *GEAR)
    assert (code, found["verdict"]) == (0, "in")
    assert found["findings"][-1] == words


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("open.stl",), "open.stl: error: mesh: not closed"),
        (("nan.ply",), "nan.ply: error: mesh: 1 of"),
        (("huge.ply",), "huge.ply: error: mesh: coordinates reach"),
        (("nowhere.stl",), "there is no such file"),
        (("gear.stl", "--teeth", "20"), "a nominal gear needs --teeth and --module"),
        (("gear.stl", "--sides", "6"), "a nominal polygon needs --sides and --across-flats"),
        (("gear.stl", "--helix", "3"), "--helix belongs to a nominal gear"),
        (("gear.stl", "--class", "6"), "--class belongs to a nominal gear"),
        (("gear.stl", "--tolerance", "h13"), "--tolerance belongs to a nominal polygon"),
        (("gear.stl", *GEAR, "--sides", "6"), "a nominal is named twice"),
        (("gear.stl", *GEAR, "--teeth-to-measure", "1;2"), "valid: all, or numbers"),
        (("gear.stl", *GEAR, "--teeth-to-measure", "21"), "there is no tooth 21"),
        (("gear.stl", *GEAR, "--csv", "/nowhere/t.csv"), "cannot be written"),
        (("gear.stl", "--pressure-angle", "90"), "normal_pressure_angle_deg is 90"),
        (("gear.stl", "--sides", "6", "--across-flats", "17", "--tolerance", "js9"), "'js9' is unknown"),
    ],
)
def test_unusable_input_is_one_line_and_exit_2(run, arguments, words):
    code, out, err = run(*arguments)
    assert code == 2
    assert out == ""
    assert words in err
    assert err.count("\n") == 1
