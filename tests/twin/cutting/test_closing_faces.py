"""What closes the removed solid in the air is wide, and makes no difference to the part."""

import numpy as np
import pytest

import twin.cutting.closing
import twin.cutting.cut
from twin.cutters.hob import Hob
from twin.cutting.blank import Blank
from twin.cutting.cut import cut

HOB = Hob(normal_module_mm=2.0, outside_diameter_mm=40.0, gashes=8)


def both(synthetic, monkeypatch, z_end, tip_x, bore):
    """The removed solid and the part, with wide faces and with fine ones only."""
    tool = synthetic.hobbing(
        HOB, teeth=10, tip_x=tip_x, z=(14.0, z_end), feed=2.0, step_deg=8.0, ratio_factor=-1.0
    )
    blank = Blank(diameter_mm=24.0, length_mm=6.0, bore_mm=bore)
    removed = []
    subtract = twin.cutting.cut.subtract

    def kept(blank, *surfaces):
        removed.extend(surfaces)
        return subtract(blank, *surfaces)

    monkeypatch.setattr(twin.cutting.cut, "subtract", kept)
    parts = []
    for wide in (twin.cutting.closing.WIDE, ()):
        monkeypatch.setattr(twin.cutting.closing, "WIDE", wide)
        parts.append(cut(blank, (tool,), cell_mm=0.3).remains)
    return removed, parts


def directed(faces):
    pairs = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    return set(map(tuple, pairs.tolist()))


# through the whole face, stopped halfway, and down to the work axis, where a core is kept
@pytest.mark.parametrize(("z_end", "tip_x", "bore"), [(-20.0, 7.5, 6.0), (-3.0, 7.5, 6.0), (-3.0, 0.0, 0.0)])
def test_wide_closing_faces_leave_the_same_part(z_end, tip_x, bore, synthetic, monkeypatch):
    (wide, fine), (one, other) = both(synthetic, monkeypatch, z_end, tip_x, bore)
    sides = directed(wide.faces)
    assert len(sides) == wide.faces.size
    assert sides == {(b, a) for a, b in sides}
    assert len(np.unique(wide.faces)) == len(wide.vertices)
    air = [(s.bite[s.faces] < 0).all(axis=1).sum() for s in (wide, fine)]
    assert air[0] < 0.6 * air[1]
    assert one.volume_mm3 == pytest.approx(other.volume_mm3, rel=1e-12)
    assert one.genus == other.genus
    assert len(one.faces) == len(other.faces)
    np.testing.assert_array_equal(np.sort(one.vertices, axis=0), np.sort(other.vertices, axis=0))
