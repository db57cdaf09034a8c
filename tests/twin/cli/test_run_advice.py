"""A run says what a check would have said: on the terminal, in alarms.json, on the page."""

import json
from pathlib import Path

import pytest

from twin.cli import main

SCENE = Path(__file__).parents[3] / "scenes" / "hexagon_af17_original"


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    out = tmp_path_factory.mktemp("run") / "result"
    code = main(["run", str(SCENE), "--ideal", "--cell-mm", "0.5", "--quiet", "--out", str(out)])
    return code, out


def test_advice_stands_in_the_result_folder(result):
    """geometry.md, section 3: the faces measured are as concave as was foreseen."""
    code, out = result
    assert code == 1
    (warning,) = json.loads((out / "alarms.json").read_text(encoding="utf-8"))["warnings"]
    assert (warning["number"], warning["line"]) == ("HT9202", 6)
    measured = json.loads((out / "inspection.json").read_text(encoding="utf-8"))["bow_um"]
    assert warning["value"] == pytest.approx(measured, rel=0.05)
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "HT9202" in page
    assert "CONCAVE FACES" in page


def test_an_event_that_cannot_be_is_refused_before_anything_is_written(tmp_path, capsys):
    out = tmp_path / "result"
    assert main(["run", str(SCENE), "--event", "5 jump", "--out", str(out)]) == 2
    assert "--event: unknown operator action 'jump'" in capsys.readouterr().err
    assert not out.exists()
