"""The report in a real browser: opened from the disk, used by mouse and by keys, printed."""

import io
import json
import re
from dataclasses import replace

import numpy as np
import pytest

from twin.inspection.result import Inspection
from twin.report import Message, Severity
from twin.report.sections import SECTIONS
from twin.report.sections.verdict import PICTURE_SIZE

TABS = ("overview", "part", "sheet", "process", "origin")
READ_PIXELS = """async (view) => {
  const canvas = document.querySelector(".stage canvas");
  const gl = canvas.getContext("webgl2");
  document.querySelector(`[data-view="${view}"]`).click();
  /* in the frame of that drawing the buffer still holds it */
  await new Promise((done) => requestAnimationFrame(done));
  const pixels = new Uint8Array(4 * canvas.width * canvas.height);
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let covered = 0, red = 0;
  for (let k = 0; k < pixels.length; k += 4) {
    covered += pixels[k + 3] / 255;
    red += pixels[k] > pixels[k + 2] + 60;
  }
  return { covered, red, width: canvas.width, height: canvas.height };
}"""
CUT_OFF = """() => {
  const found = [];
  for (const svg of document.querySelectorAll(".tab.shown .chart svg")) {
    const { width, height } = svg.viewBox.baseVal, all = svg.getBoundingClientRect();
    for (const text of svg.querySelectorAll("text")) {
      const box = text.getBoundingClientRect(), edge = all.width / width;
      if (box.left < all.left - edge || box.right > all.right + edge ||
          box.top < all.top - edge || box.bottom > all.bottom + edge) found.push(text.textContent);
    }
  }
  return found;
}"""
OVERLAPS = """() => {
  const found = [];
  for (const svg of document.querySelectorAll(".tab.shown .chart svg")) {
    const all = [...svg.querySelectorAll("text")];
    const boxes = all.map((text) => [text.textContent, text.getBoundingClientRect()]);
    boxes.forEach(([one, a], k) => boxes.slice(k + 1).forEach(([other, b]) => {
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (across > 1 && down > 0.4 * Math.min(a.height, b.height)) found.push([one, other]);
    }));
  }
  return found;
}"""


def polygon(sample):
    return sample.report(inspection=sample.polygon_inspection(), part=sample.hexagon_part())


def alarm_only(sample):
    alarm = Message(
        severity=Severity.ALARM, number="PS1594", text="EGB FORMAT ERROR", file="program.nc", line=5
    )
    return sample.report(part=None, inspection=Inspection(), messages=(alarm,), recording=sample.recording(0))


CASES = {"gear": lambda sample: sample.report(), "polygon": polygon, "alarm": alarm_only}


@pytest.mark.parametrize("case", CASES)
def test_opens_from_disk_in_silence_and_asks_for_nothing(open_page, sample, case):
    opened = open_page(CASES[case](sample))
    for name in opened.page.eval_on_selector_all("[role=tab]", "all => all.map((tab) => tab.id)"):
        opened.page.click(f"#{name}")
    if case != "alarm":
        opened.tab("part")
        opened.part()
    assert opened.said == []
    assert [url for url in opened.asked if not url.startswith(("data:", "blob:"))] == [
        opened.page.url.split("#")[0]
    ]


def test_the_part_is_drawn_in_its_true_size(open_page, sample):
    report = sample.report(part=sample.gear_part(around=75, along=20))
    opened = open_page(report)
    opened.tab("part")
    opened.part()
    front = opened.page.evaluate(READ_PIXELS, "front")
    vertices = report.part.vertices
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    radius = np.linalg.norm(vertices - middle, axis=1).max()
    per_mm = 0.92 * min(front["width"], front["height"]) / (2 * radius)
    outline = vertices[: 75 * 20, :2] @ [1, 1j]
    area = (outline * np.roll(outline.conj(), 1)).imag.sum() / 2 - np.pi * 6.0**2
    assert front["covered"] == pytest.approx(area * per_mm**2, rel=0.01)
    # flanks with up to 8 µm too much are red, and from the front none of them is seen
    assert front["red"] == 0
    assert opened.page.evaluate(READ_PIXELS, "isometric")["red"] > 1000
    opened.page.click("[data-colour]")
    assert opened.page.evaluate(READ_PIXELS, "isometric")["red"] == 0


def test_the_part_turns_by_keys_and_by_the_mouse(open_page, sample):
    opened = open_page(sample.report())
    opened.tab("part")
    opened.part()
    places = "() => [...document.querySelectorAll('.numbers span')].map((n) => n.style.transform).join()"
    seen = [opened.page.evaluate(places)]

    def moved():
        opened.page.wait_for_function(f"(before) => ({places})() !== before", arg=seen[-1])
        seen.append(opened.page.evaluate(places))

    opened.page.focus(".stage canvas")
    opened.page.keyboard.press("ArrowLeft")
    moved()
    opened.page.keyboard.press("+")
    moved()
    box = opened.page.locator(".stage canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    opened.page.mouse.move(x, y)
    opened.page.mouse.down()
    opened.page.mouse.move(x + 60, y + 10, steps=4)
    opened.page.mouse.up()
    moved()
    opened.page.mouse.wheel(0, -200)
    moved()
    assert len(set(seen)) == 5


def test_without_webgl_a_still_picture_stands_in(open_page, sample):
    opened = open_page(sample.report(), script="HTMLCanvasElement.prototype.getContext = () => null;")
    opened.tab("part")
    opened.page.wait_for_selector(".viewer.failed")
    assert opened.page.is_visible(".stage .fallback")
    assert opened.page.evaluate("document.querySelector('.fallback').naturalWidth") == PICTURE_SIZE[0]
    assert "this browser has no WebGL 2" in opened.page.inner_text(".reason")


def test_tabs_by_mouse_by_keys_and_by_address(open_page, sample):
    opened = open_page(sample.report(), address="#s-pitch")
    page = opened.page

    def shown():
        found = page.eval_on_selector_all(".tab", "all => all.filter((t) => t.offsetParent).map((t) => t.id)")
        assert page.get_attribute("[role=tab][aria-selected=true]", "aria-controls") == found[0]
        assert len(found) == 1
        return found[0]

    assert shown() == "sheet"
    for name in TABS:
        opened.tab(name)
        assert shown() == name
    page.keyboard.press("ArrowRight")
    assert shown() == "overview"
    page.keyboard.press("ArrowLeft")
    assert shown() == "origin"
    page.keyboard.press("Home")
    assert shown() == "overview"
    page.keyboard.press("End")
    assert shown() == "origin"
    assert page.evaluate("document.activeElement.id") == "tab-origin"


def spans(page):
    """Left edge and width of every highlighted rectangle [mm], and the plots they lie in."""
    outline = page.get_attribute(".chosen-span", "d") or ""
    found = np.array([[float(x), float(w)] for x, w in re.findall(r"M(-?[\d.]+) [\d.]+h([\d.]+)", outline)])
    panels = json.loads(page.inner_text("[data-process]") or page.text_content("[data-process]"))["panels"]
    return found.reshape(-1, 2), np.array(panels)


def test_a_block_is_chosen_by_click_by_keys_and_from_a_plot(open_page, sample):
    report = sample.report()
    opened = open_page(report)
    opened.tab("process")
    opened.part()
    page, recording = opened.page, report.recording
    listing = page.locator(".listing")

    def chosen():
        return page.inner_text(".line[aria-selected] .n")

    def place_of(k):
        """Share of the run from which to which block k ran."""
        own = np.flatnonzero(recording.block == k)
        time = recording.time_s
        return time[max(own[0] - 1, 0)] / time[-1], time[own[-1]] / time[-1]

    for line, k in ((5, 1), (7, 3)):
        page.click(f"#line-0-{line}")
        assert chosen() == str(line)
        found, panels = spans(page)
        start, end = place_of(k)
        assert len(found) == len(panels) == 8
        np.testing.assert_allclose(found[:, 0], panels[:, 0] + start * panels[:, 2], atol=2e-3)
        np.testing.assert_allclose(found[:, 1], (end - start) * panels[:, 2], atol=2e-3)
        assert recording.blocks[k].text in page.inner_text(".chosen-block")
    assert "gear box engaged" in page.inner_text(".chosen-block")
    listing.focus()
    page.keyboard.press("ArrowDown")
    assert chosen() == "8"
    page.keyboard.press("ArrowUp")
    page.keyboard.press("ArrowUp")
    assert chosen() == "6"
    page.keyboard.press("Home")
    assert chosen() == "1"
    assert "moved nothing" in page.inner_text(".chosen-block")
    assert len(spans(page)[0]) == 0
    # a click into the second plot, in the middle of the fourth of five equal blocks
    _, panels = spans(page)
    drawing = page.locator("#motion").bounding_box()
    scale = drawing["width"] / 180.0
    left, top, width, height = panels[1]
    page.locator("#motion").click(
        position={"x": (left + 0.7 * width) * scale, "y": (top + height / 2) * scale}
    )
    assert chosen() == "7"
    assert opened.said == []


TWO_ENDS = """async (pixel) => {
  const canvas = document.querySelector(".stage canvas");
  const gl = canvas.getContext("webgl2");
  document.querySelector('[data-view="side"]').click();
  await new Promise((done) => requestAnimationFrame(done));
  const pixels = new Uint8Array(4 * canvas.width * canvas.height);
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const green = [], covered = [];
  for (let k = 0; k < canvas.width * canvas.height; k++) {
    const [r, g, b, a] = pixels.subarray(4 * k, 4 * k + 4), row = Math.floor(k / canvas.width);
    if (a) covered.push(row);
    if (a && g > r + 40 && g > b + 20) green.push(row);
  }
  const most = (all) => all.reduce((x, y) => Math.max(x, y), -1);
  const least = (all) => all.reduce((x, y) => Math.min(x, y), 1e9);
  return { green: green.length, covered: covered.length, low: least(green), high: most(green),
           bottom: least(covered), top: most(covered), scale: canvas.width / canvas.clientWidth };
}"""


def test_a_block_shows_what_it_cut_and_is_found_by_it(open_page, sample):
    """The upper half was cut by line 5, the lower by line 7, the bore and the rear by nobody."""
    part = sample.gear_part(around=60, along=21)
    z = part.vertices[part.faces][..., 2]
    turned = np.hypot(*part.vertices[part.faces][..., :2].T).T > 12.0
    recording = sample.report().recording
    middle = [recording.time_s[recording.block == k].mean() for k in (1, 3)]
    half = np.where((z >= -10.0 - 1e-9).all(axis=1), middle[0], middle[1])
    time = np.where(turned.all(axis=1), half, np.nan)
    opened = open_page(sample.report(part=replace(part, face_time_s=time)))
    opened.tab("process")
    opened.part()
    page = opened.page

    def shown(line):
        page.click(f"#line-0-{line}")
        return page.evaluate(TWO_ENDS)

    upper, lower, none = shown(5), shown(7), shown(8)
    assert none["green"] == 0
    assert "Nothing of the finished surface is its work" in page.inner_text(".chosen-block")
    height = upper["top"] - upper["bottom"]
    assert (upper["low"] - upper["bottom"]) / height == pytest.approx(0.5, abs=0.02)
    assert (upper["high"] - upper["bottom"]) / height == pytest.approx(1.0, abs=0.02)
    assert (lower["low"] - lower["bottom"]) / height == pytest.approx(0.0, abs=0.02)
    assert (lower["high"] - lower["bottom"]) / height == pytest.approx(0.5, abs=0.02)
    assert upper["green"] + lower["green"] == pytest.approx(upper["covered"], rel=0.05)
    # half of the surface each, in words
    page.click("#line-0-5")
    words = page.inner_text(".chosen-block")
    a, b, c = part.vertices[part.faces].transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    assert f"{area[time == middle[0]].sum():.1f} mm²" in words
    assert "50.0 %" in words
    # and from the part to the block
    box = page.locator(".stage canvas").bounding_box()
    centre = box["x"] + box["width"] / 2
    for line, share in ((7, 0.25), (5, 0.75)):
        row = lower["bottom"] + share * height
        page.mouse.click(centre, box["y"] + box["height"] - row / lower["scale"])
        assert page.inner_text(".line[aria-selected] .n") == str(line)
    assert opened.said == []


def test_a_tooth_is_chosen_among_the_maps(open_page, sample):
    opened = open_page(sample.report())
    opened.tab("part")
    opened.part()
    page = opened.page
    tiles = json.loads(page.text_content("[data-tiles]"))
    assert [tile["name"] for tile in tiles] == 2 * [str(k) for k in range(1, 21)]
    left, top, width, height = next(t for t in tiles if t["row"] == "Right flanks" and t["name"] == "7")[
        "box"
    ]
    drawing = page.locator("#maps").bounding_box()
    scale = drawing["width"] / 180.0
    page.locator("#maps").click(position={"x": (left + width / 2) * scale, "y": (top + height / 2) * scale})
    assert page.inner_text(".lens-head strong") == "Tooth 7"
    boxes = page.eval_on_selector_all(".lens svg", "all => all.map((s) => s.getAttribute('viewBox'))")
    assert boxes[1] == " ".join(f"{value:g}" for value in (left, top, width, height)) or [
        float(x) for x in boxes[1].split()
    ] == pytest.approx([left, top, width, height])
    page.focus("#maps-chart")
    page.keyboard.press("ArrowRight")
    assert page.inner_text(".lens-head strong") == "Tooth 8"
    page.click(".lens-head [data-step='-1']")
    assert page.inner_text(".lens-head strong") == "Tooth 7"


@pytest.mark.parametrize("width", [400, 1280, 1920])
@pytest.mark.parametrize("case", CASES)
def test_nothing_is_cut_off_at_any_width(open_page, sample, case, width):
    opened = open_page(CASES[case](sample), width=width)
    for name in opened.page.eval_on_selector_all("[role=tab]", "all => all.map((tab) => tab.id)"):
        opened.page.click(f"#{name}")
        assert opened.page.evaluate("document.documentElement.scrollWidth") <= width, name
        assert opened.page.evaluate(CUT_OFF) == [], name
        assert opened.page.evaluate(OVERLAPS) == [], name


@pytest.mark.parametrize(
    ("case", "before", "verdict"),
    [("gear", 2, "In tolerance"), ("polygon", 2, "In tolerance"), ("alarm", 1, "No part")],
)
def test_prints_on_a4(open_page, sample, case, before, verdict):
    """Overview and maps on the first sheets; then every section that asks for a page of its own has one."""
    pypdf = pytest.importorskip("pypdf", reason="pypdf is not installed")
    opened = open_page(CASES[case](sample), address="#process")
    printed = pypdf.PdfReader(io.BytesIO(opened.page.pdf(prefer_css_page_size=True)))
    sections = [section for build in SECTIONS if (section := build(CASES[case](sample))) is not None]
    own = [section.title for section in sections if section.own_page]
    words = [" ".join(page.extract_text().split()) for page in printed.pages]
    assert len(printed.pages) == before + len(own)
    for number, page in enumerate(printed.pages, start=1):
        assert [float(x) for x in page.mediabox[2:]] == pytest.approx([595.3, 841.9], abs=1.0)
        assert f"page {number} of {len(printed.pages)}" in words[number - 1]
        assert "spur_m2_z20" in words[number - 1]
    for title, text in zip(own, words[before:], strict=True):
        assert title in text
    assert verdict in words[0]
    if case == "gear":
        gear = sample.gear_inspection().gear
        flanks, pitch = (
            words[before + own.index(title)] for title in ("Profile and helix", "Pitch and runout")
        )
        for side in (gear.left, gear.right):
            assert f"{side.profile_form_um:.1f}" in flanks
            assert f"{side.cumulative_pitch_um:.1f} µm" in pitch
