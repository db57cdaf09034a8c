"""`hobtwin explain` and the reference page: everything in the tables, and nothing that is not."""

import json
import re
from pathlib import Path

import pytest

from controller.operator.actions import ACTIONS
from controller.tables.alarm_notes import NOTES
from controller.tables.alarms import ALARMS
from controller.tables.codes import G_CODES, M_CODES
from controller.tables.parameter_table import PARAMETERS
from controller.tables.signals import SIGNALS
from twin.advice.kinds import KINDS
from twin.cli import main
from twin.errors import InputError
from twin.manual.book import entries, find
from twin.manual.entry import Chapter

REFERENCE = Path(__file__).parents[3] / "docs" / "reference.md"


@pytest.fixture
def explain(capsys):
    def _explain(*names):
        code = main(["explain", *names])
        said = capsys.readouterr()
        assert "Traceback" not in said.err
        return code, said.out, said.err

    return _explain


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (
            ["PS1594"],
            ["EGB FORMAT ERROR", "program; the gear box stays on", "G81, G80", "rulings, section 2"],
        ),
        (["OT0500"], ["overtravel; the gear box is cancelled"]),
        (["G81"], ["hobbing synchronisation on", "Supported", "yes", "PS1594 EGB FORMAT ERROR", "指令格式"]),
        (["g50.2"], ["polygon turning off", "in force at power-on", "PS0219"]),
        (["G41"], ["no: HT9003"]),
        (["M19"], ["before the motion of the block"]),
        (["M3"], ["M03"]),
        (["201"], ["201#7", "201#4  ECN", "201#3", "201#2"]),
        (["201#4"], ["ECN", "Delivered  0"]),
        (["8210"], ["-180000 to 180000", "Delivered (tilted)", "-30000"]),
        (["1320.Z"], ["stored stroke limit 1, plus side", "Z 400"]),
        (["NOZAGC"], ["G63.5", "--signal NOZAGC=0 or 1"]),
        (["NOGAGC"], ["NOZAGC"]),
        (["*ITX"], ["interlock", "Cartesian", "1 unless set"]),
        (["+JX"], ["no; instead", "jog"]),
        (["feed hold"], ["--event"]),
        (["feed", "hold"], ["--event"]),
        (["HT9202"], ["CONCAVE FACES", "warning"]),
        (["0005"], ["PS0005"]),
        (["PS5"], ["PS0005"]),
        (["MC3005"], ["USER ALARM", "user; the gear box stays on"]),
        (["G81", "G80"], ["hobbing synchronisation on", "hobbing synchronisation off"]),
    ],
)
def test_a_name_is_explained_from_its_table(explain, names, words):
    code, out, _ = explain(*names)
    assert code == 0
    for word in words:
        assert word in out


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("PS1549", "PS1594"),
        ("G81.1", "G81"),
        ("8213", "8212"),
        ("NOZAG", "NOZAGC"),
        ("feed hld", "feed hold"),
    ],
)
def test_an_unknown_name_is_answered_with_the_nearest(explain, name, near):
    code, out, err = explain(name)
    assert (code, out) == (2, "")
    assert name in err
    assert near in err


def test_words_of_a_title_lead_to_the_names(explain):
    code, _, err = explain("polygon")
    assert code == 2
    assert "G51.2" in err


def test_what_is_like_nothing_gets_a_hint(explain):
    code, _, err = explain("???")
    assert code == 2
    assert "explain alone lists them" in err


def test_alone_it_lists_everything_by_chapter(explain):
    code, out, _ = explain()
    assert code == 0
    for entry in entries():
        assert re.search(rf"^  {re.escape(entry.name)}\s", out, re.MULTILINE), entry.name
    assert [line for line in out.splitlines() if line and line[0] != " "] == [c.value for c in Chapter]


def test_every_row_of_every_table_has_its_entry():
    names = {chapter: {e.name for e in entries() if e.chapter is chapter} for chapter in Chapter}
    assert names[Chapter.G_CODE] == {code.name for code in G_CODES.values()}
    assert names[Chapter.M_CODE] == {code.name for code in M_CODES.values()}
    assert names[Chapter.ALARM] | names[Chapter.WARNING] == set(ALARMS)
    assert names[Chapter.ADVICE] == {kind.value for kind in KINDS}
    assert names[Chapter.PARAMETER] == {
        f"{number}#{bit}" for number, row in PARAMETERS.items() for bit in row.bits
    } | {str(number) for number, row in PARAMETERS.items() if not row.bits}
    assert len(names[Chapter.SIGNAL]) == len(SIGNALS)
    assert names[Chapter.EVENT] == {row.action.value for row in ACTIONS.values()}


def test_every_entry_says_where_it_is_laid_down_and_what_to_do():
    for entry in entries():
        rows = dict(entry.rows)
        assert entry.title
        assert rows["Clause"], entry.name
        assert all(text for text in rows.values()), entry.name
        if entry.chapter in (Chapter.ALARM, Chapter.WARNING, Chapter.ADVICE):
            assert rows["Remedy"], entry.name


def test_names_of_parameters_signals_and_events_are_unique():
    for chapter in (Chapter.G_CODE, Chapter.M_CODE, Chapter.SIGNAL, Chapter.EVENT):
        seen: set[str] = set()
        for entry in entries():
            if entry.chapter is chapter:
                assert not seen & entry.names, entry.name
                seen |= entry.names


def test_notes_belong_to_alarms_and_name_codes_that_exist():
    codes = {code.name for code in G_CODES.values()} | {code.name for code in M_CODES.values()}
    for number, note in NOTES.items():
        assert number in ALARMS, number
        assert note.meaning
        assert note.clause
        assert set(note.codes) <= codes, number


def test_find_refuses_nonsense_with_a_place_to_look():
    with pytest.raises(InputError, match="explain alone lists them"):
        find("")


def test_json_has_one_object_an_entry(explain):
    _, out, _ = explain("PS1594", "--format", "json")
    (entry,) = json.loads(out)
    assert entry["name"] == "PS1594"
    assert entry["remedy"] == ALARMS["PS1594"].remedy


def test_the_reference_page_is_the_one_the_tables_give(explain):
    """`hobtwin explain --all --format markdown > docs/reference.md` writes it anew."""
    _, out, _ = explain("--all", "--format", "markdown")
    assert REFERENCE.read_text(encoding="utf-8") == out
