"""The page as a whole: well formed, safe, alone, and honest about what is missing."""

import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

from twin.errors import InputError
from twin.inspection.result import Inspection, Verdict
from twin.report import Message, Program, Row, Severity, write_report
from twin.report.page import render

VOID = {"meta", "link", "img", "input", "br"}
ALARM = Message(
    severity=Severity.ALARM,
    number="PS1594",
    text="EGB FORMAT ERROR",
    file="program.nc",
    line=5,
    column=1,
    found="T missing",
    remedy="G81 T20 L1",
)


class Page(HTMLParser):
    """Text, tags and attributes of a page; every tag must close in its order."""

    def __init__(self, html):
        super().__init__(convert_charrefs=True)
        self.open, self.tags, self.attributes, self.ids = [], [], [], []
        self.text, self.scripts = [], []
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += [(tag, name, value) for name, value in attrs]
        self.ids += [value for name, value in attrs if name == "id"]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        (self.scripts if self.open and self.open[-1] in ("script", "style") else self.text).append(data)

    @property
    def words(self):
        return " ".join(" ".join(self.text).split())


@pytest.fixture(scope="module")
def gear_html(sample):
    return render(sample.report())


def variants(sample):
    nothing = {"recording": None, "part": None, "inspection": Inspection(), "programs": (), "messages": ()}
    no_samples = sample.recording(0)
    blank_gear = sample.gear_inspection().gear
    blind = replace(
        blank_gear.left,
        profile=(),
        helix=(),
        pitch_um=np.full(20, np.nan),
        cumulative_um=np.full(20, np.nan),
        profile_slope_um=None,
        profile_form_um=None,
        profile_total_um=float("nan"),
        helix_slope_um=None,
        helix_form_um=None,
        helix_total_um=None,
        single_pitch_um=None,
        cumulative_pitch_um=None,
    )
    hexagon = sample.polygon_inspection()
    return {
        "gear": {},
        "polygon": {"inspection": hexagon, "part": sample.hexagon_part()},
        "polygon without outline": {
            "inspection": replace(
                hexagon, polygon=replace(hexagon.polygon, section=np.zeros((0, 2)), faces=())
            )
        },
        "gear without a trace": {
            "inspection": Inspection(
                gear=replace(
                    blank_gear, left=blind, right=blind, lead_mm=None, span_teeth=None, span_mm=None
                ),
                unmeasured={"span_mm": "the tool does not reach"},
            )
        },
        "neither": {
            "inspection": Inspection(reason="the teeth overlap", nominal=sample.gear_inspection().nominal)
        },
        "alarms only": nothing | {"messages": (ALARM,)},
        "nothing": nothing,
        "no samples": {"recording": no_samples},
        "one sample": {"recording": sample.recording(1)},
        "no deviation": {
            "part": replace(
                sample.hexagon_part(), deviation_um=np.full(len(sample.hexagon_part().vertices), np.nan)
            )
        },
        "no faces": {"part": replace(sample.hexagon_part(), faces=np.zeros((0, 3), int))},
    }


VARIANTS = (
    "gear",
    "polygon",
    "polygon without outline",
    "gear without a trace",
    "neither",
    "alarms only",
    "nothing",
    "no samples",
    "one sample",
    "no deviation",
    "no faces",
)


@pytest.mark.parametrize("name", VARIANTS)
def test_every_variant_is_well_formed_and_says_no_none(sample, name):
    html = render(sample.report(**variants(sample)[name]))
    page = Page(html)
    assert html.startswith("<!DOCTYPE html>")
    assert len(page.ids) == len(set(page.ids))
    assert not re.search(r"\b(none|nan|inf)\b", page.words, re.IGNORECASE), page.words
    assert not [a for a in page.attributes if a[2] and re.search(r"\b(None|nan)\b", a[2])]


@pytest.mark.parametrize("name", ["gear", "polygon"])
def test_nothing_is_fetched(sample, name):
    html = render(sample.report(**variants(sample)[name]))
    without_names = re.sub(r' xmlns(:\w+)?="http://www\.w3\.org/[^"]*"', "", html)
    assert not re.search(r"https?:|(?<![\w/+])//\w+\.\w+/|@import|url\((?!#)", without_names)
    sources = [
        v for _, name, v in Page(html).attributes if name in ("src", "href", "xlink:href", "action", "data")
    ]
    assert sources
    assert all(value.startswith(("data:", "#")) for value in sources)


def test_what_a_user_wrote_stays_text(sample):
    evil = '"><script>alert(1)</script></script><img src=x onerror=alert(2)>&amp;'
    plain = Page(render(sample.report()))
    message = Message(
        severity=Severity.WARNING, number=evil, text=evil, file=evil, line=1, found=evil, remedy=evil
    )
    inspection = replace(sample.gear_inspection(), findings=(evil,), unmeasured={evil: evil})
    page = Page(
        render(
            sample.report(
                title=evil,
                job=(Row(label=evil, value=evil),),
                provenance=(Row(label=evil, value=evil),),
                messages=(message,),
                inspection=inspection,
                programs=(Program(name=evil, text=evil),),
            )
        )
    )
    assert page.tags.count("script") == plain.tags.count("script")
    assert page.tags.count("img") == plain.tags.count("img")
    assert not [a for a in page.attributes if a[1].startswith("on")]
    assert page.words.count(evil) >= 12


def test_bytes_that_are_no_text_do_no_harm(sample, tmp_path):
    junk = "G01\x00\x07\x1b[31m\udcff\ufffe X1"
    path = tmp_path / "report.html"
    write_report(path, sample.report(title=junk, programs=(Program(name="p", text=junk),)))
    html = path.read_bytes().decode("utf-8")
    assert not re.search(r"[\x00-\x08\x0b\x0c\x0e-\x1f]", html)
    assert "G01" in Page(html).words


def test_the_same_run_gives_the_same_page(sample, gear_html):
    assert render(sample.report()) == gear_html


def test_a_file_that_cannot_be_written_is_named(sample, tmp_path):
    path = tmp_path / "missing" / "report.html"
    with pytest.raises(InputError, match="cannot write the report: No such file") as caught:
        write_report(path, sample.report(part=None))
    assert str(caught.value).startswith(str(path))


def test_alarm_stands_in_the_headline_in_the_list_and_at_its_line(sample):
    page = Page(render(sample.report(messages=(ALARM,))))
    assert page.words.count("PS1594") == 3
    assert "program.nc:5:1" in page.words
    assert ("div", "class", "line alarm") in page.attributes


def test_values_out_of_tolerance_are_marked(sample):
    inspection = sample.gear_inspection()
    gear = replace(inspection.gear, tolerances_um={"profile_total": 5.0, "helix_total": 8.0})
    page = Page(render(sample.report(inspection=replace(inspection, gear=gear, verdict=Verdict.OUT))))
    found = {
        side: {item: getattr(getattr(gear, side), f"{item}_total_um") for item in ("profile", "helix")}
        for side in ("left", "right")
    }
    expected = sum(
        value > limit
        for side in found.values()
        for value, limit in ((side["profile"], 5.0), (side["helix"], 8.0))
    )
    assert expected == 2
    traces = sum(
        trace.total_um > limit
        for side in (gear.left, gear.right)
        for traces, limit in ((side.profile, 5.0), (side.helix, 8.0))
        for trace in traces
    )
    # in the overview, then on the sheet: the results, and every tooth
    assert page.attributes.count(("td", "class", "out")) == expected + traces
    assert page.attributes.count(("td", "class", "result out")) == expected


def test_a_long_program_is_cut_but_never_around_a_message(sample):
    text = "\n".join(f"N{k} G01 X{k}." for k in range(1, 100_001))
    message = replace(ALARM, line=70_000)
    page = Page(
        render(
            sample.report(part=None, programs=(Program(name="program.nc", text=text),), messages=(message,))
        )
    )
    assert "N70000 G01" in page.words
    assert "N69997 G01" in page.words
    assert "N50000 G01" not in page.words
    assert "67996 lines not shown" in page.words
    assert "29997 lines not shown" in page.words


def test_a_thinned_view_says_so(sample, monkeypatch):
    monkeypatch.setattr("twin.report.sections.part.MOST_TRIANGLES", 1000)
    part = sample.gear_part(around=30, along=20)
    page = Page(render(sample.report(part=part)))
    said = re.search(r"simplified: (\d+) of (\d+) triangles", page.words)
    assert said is not None
    assert int(said[1]) <= 1000
    assert int(said[2]) == len(part.faces)


def test_half_a_million_triangles_stay_a_small_file(sample, tmp_path):
    part, recording = sample.gear_part(), sample.recording(150_000)
    assert len(part.faces) > 500_000
    path = tmp_path / "report.html"
    write_report(path, sample.report(part=part, recording=recording))
    assert path.stat().st_size < 8e6


def test_symbols_in_findings_are_set_and_file_names_are_not(sample):
    findings = ("total profile deviation F_α of 30 µm", "slope f_Hβ, F_p: see f_p.nc and F_rank <b>")
    report = sample.report(inspection=replace(sample.gear_inspection(), findings=findings))
    html = render(report)
    assert "deviation F<sub>α</sub> of 30 µm." in html
    assert "Slope f<sub>Hβ</sub>, F<sub>p</sub>: see f_p.nc and F_rank &lt;b&gt;." in html
