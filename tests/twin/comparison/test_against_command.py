"""`hobtwin inspect A --against B` as a user meets it."""

import json

import pytest
import trimesh

from twin.cli import main


@pytest.fixture
def files(parts, tmp_path):
    def thick(tooth, side, roll, z):
        return 0 * roll + (0.005 if tooth == 2 else 0.0)

    shape = {"teeth": 12, "module": 2.0, "width": 6.0, "roll_step": 0.3, "z_step": 1.0}
    for name, mesh in (
        ("a", parts.gear_mesh(**shape)),
        ("b", parts.gear_mesh(**shape, error=thick)),
        ("hexagon", parts.polygon_mesh(across_flats=17.0, cutter_radius=40.0, inserts=3, sides=6, width=6.0)),
    ):
        trimesh.Trimesh(*mesh, process=False).export(tmp_path / f"{name}.stl")
    return tmp_path


def against(files, a, b, *options):
    return main(["inspect", str(files / a), "--against", str(files / b), *options])


def test_the_same_file_differs_by_nothing(files, capsys):
    assert against(files, "a.stl", "a.stl", "--tolerance-um", "0") == 0
    said = capsys.readouterr().out
    assert "largest 0.00 µm" in said
    assert "none of" in said
    assert "0.00 µm: within the tolerance 0 µm" in said


def test_the_tolerance_makes_a_difference_a_finding(files, capsys):
    assert against(files, "b.stl", "a.stl") == 0
    said = capsys.readouterr().out
    assert "tooth 11" in said
    assert "flanks.left.single_pitch_um" in said
    assert against(files, "b.stl", "a.stl", "--tolerance-um", "3") == 1
    assert "beyond the tolerance 3 µm" in capsys.readouterr().out
    assert against(files, "b.stl", "a.stl", "--tolerance-um", "6") == 0


def test_json_and_page(files, capsys):
    page = files / "page.html"
    assert against(files, "b.stl", "a.stl", "--format", "json", "--report", str(page)) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["surface"]["most"]["deviation_um"] == pytest.approx(5.0, rel=0.03)
    assert found["surface"]["most"]["place"] == "tooth 11"
    assert found["largest_um"] >= found["surface"]["most"]["deviation_um"]
    changed = {change["key"] for change in found["changes"] if change["changed"]}
    assert "flanks.left.single_pitch_um" in changed
    assert "number_of_teeth" not in changed
    html = page.read_text(encoding="utf-8")
    assert html.count("data:image/png;base64,") == 2
    assert "b.stl against a.stl" in html
    assert "http" not in html


def test_a_gear_against_a_hexagon(files, capsys):
    assert against(files, "a.stl", "hexagon.stl") == 0
    assert "A is a gear, B is a polygon" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["a.stl", "--tolerance-um", "3"], "--tolerance-um belongs to a comparison (add --against MESH)"),
        (["a.stl", "--report", "x.html"], "--report belongs to a comparison"),
        (["a.stl", "--against-units", "inch"], "--against-units belongs to a comparison"),
        (["a.stl", "--against", "a.stl", "--tolerance-um", "nan"], "--tolerance-um nan"),
        (["a.stl", "--against", "a.stl", "--tolerance-um", "-1"], "--tolerance-um -1"),
        (["a.stl", "--against", "a.stl", "--csv", "x.csv"], "--csv writes the traces of one part"),
        (["a.stl", "--against", "none.stl"], "none.stl: error: there is no such file"),
        (["a.stl", "--against", "open.stl"], "open.stl: error: mesh: not closed"),
        (["a.stl", "--against", "a.stl", "--against-units", "inch"], "--against-units is B's"),
        (["a.stl", "--against", "a.stl", "--report", "no/such/x.html"], "error: No such file or directory"),
    ],
)
def test_what_cannot_be_compared(files, monkeypatch, capsys, arguments, said):
    monkeypatch.chdir(files)
    mesh = trimesh.load_mesh("a.stl")
    mesh.update_faces([k != 5 for k in range(len(mesh.faces))])
    mesh.export("open.stl")
    assert main(["inspect", *arguments]) == 2
    captured = capsys.readouterr()
    assert said in captured.err
    assert captured.err.count("\n") == 1
    assert not (files / "x.html").exists()
