"""The picture of a collision: the two bodies, the place, and a file of its own."""

from xml.etree import ElementTree

import numpy as np
import pytest

from twin.machine import Setup, ToolMount, WorkMount, assemble, load_machine
from twin.machine.collisions import touch_at
from twin.machine.silhouette import outlines
from twin.report import ReportData
from twin.report.charts.contact import contact_chart, contact_file
from twin.report.data import Contact
from twin.report.sections.contact import contact_section


@pytest.fixture(scope="module")
def contact():
    """By hand: a hob of Ø 70 with its tips at X21 on an arbor of Ø 21, 100 mm behind the front face."""
    assembly = assemble(
        load_machine("hobbing_lathe"),
        Setup.HOBBING,
        work=WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0, stick_out_mm=300.0),
        tool=ToolMount(carrier_swivel_deg=90.0, radius_mm=35.0, length_mm=80.0, edges=12),
    )
    axes = np.array([(21.0 - 400.0) / 2.0, -100.0 - 300.0, 0.0, 0.0])
    touch = touch_at(assembly, axes)
    assert touch is not None
    assert touch.bodies == ("cutter", "arbor")
    shapes = tuple((shape.body, shape.points) for shape in outlines(assembly, axes))
    return Contact(bodies=touch.bodies, point=touch.point, shapes=shapes, found="cutter touches arbor")


def test_the_place_is_where_tip_and_arbor_meet(contact):
    x, _, z = contact.point
    assert x == pytest.approx(10.5, abs=0.01)
    assert z == pytest.approx(-100.0, abs=0.5)
    hulls = {body: points for body, points in contact.shapes if body in contact.bodies}
    assert hulls["cutter"][:, 0].min() == pytest.approx(10.5, abs=0.01)
    assert np.ptp(hulls["arbor"][:, 0]) == pytest.approx(21.0, abs=0.01)
    assert hulls["arbor"][:, 2].max() == pytest.approx(-20.0, abs=1e-6)


def test_both_bodies_stand_out_in_both_views(contact):
    chart = contact_chart(contact)
    assert chart.count('class="touching"') == chart.count('class="touched"') == 2
    assert chart.count('class="place"') == 2
    assert "nan" not in chart
    section = contact_section(ReportData(title="a", contact=contact))
    assert section is not None
    assert (section.values["moving"], section.values["fixed"]) == ("cutter", "arbor")
    assert contact_section(ReportData(title="a")) is None


def test_the_file_is_svg_on_its_own(contact):
    root = ElementTree.fromstring(contact_file(contact))
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
