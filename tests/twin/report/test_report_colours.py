"""What a colour means."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from twin.report.colours import COVERED, ZERO, Legend, Scale, palette, scale_for

values = hnp.arrays(np.float64, st.integers(1, 200), elements=st.floats(-1e5, 1e5))


@given(values)
def test_the_scale_is_round_and_holds_what_it_says(deviation):
    scale = scale_for(deviation)
    mantissa = scale.limit_um / 10 ** np.floor(np.log10(scale.limit_um) + 1e-9)
    assert mantissa == pytest.approx(1) or mantissa == pytest.approx(2) or mantissa == pytest.approx(5)
    assert np.mean(np.abs(deviation) > scale.limit_um) == pytest.approx(scale.beyond)
    assert scale.beyond <= 1 - COVERED + 1 / len(deviation)


@given(values)
def test_an_index_says_the_value_to_half_a_step(deviation):
    scale = Scale(limit_um=50.0, beyond=0.0)
    index = scale.index(deviation).astype(float)
    read = (index - ZERO) / (ZERO - 1) * 50.0
    np.testing.assert_allclose(read, np.clip(deviation, -50, 50), atol=50.0 / (ZERO - 1) / 2 + 1e-9)
    np.testing.assert_array_equal(index + scale.index(-deviation), 2 * ZERO)


def test_no_value_has_the_colour_of_steel():
    scale = Scale(limit_um=5.0, beyond=0.0)
    np.testing.assert_array_equal(
        scale.index(np.array([np.nan, 0.0, 5.0, -5.0, 9.0])), [0, ZERO, 255, 1, 255]
    )
    assert scale_for(np.array([np.nan])) is None
    assert scale_for(np.zeros(0)) is None


def test_ticks_stand_where_their_values_are():
    for height, text in Scale(limit_um=20.0, beyond=0.0).ticks():
        assert float(text.replace("−", "-")) == pytest.approx((height - 50) / 50 * 20)


def test_both_ways_the_colours_grow_darker_and_part_in_hue():
    """Told apart without hue by lightness from zero, without red-green by blue against red."""
    colours = palette()[1:].astype(float)
    light = colours @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(light[127:]) < 1).all()
    assert (np.diff(light[:127]) > -1).all()
    assert light[127] > 240
    # A deuteranope confuses red and green but not their mean against blue.
    yellow_blue = colours[:, :2].mean(axis=1) - colours[:, 2]
    assert yellow_blue[40] < -30
    assert yellow_blue[214] > 30


@pytest.mark.parametrize(
    ("far", "said"), [(0, ""), (1, "less than 0.1"), (5, "0.1"), (50, "0.5"), (100, "1.0")]
)
def test_what_lies_beyond_the_scale_is_never_said_to_be_nothing(far, said):
    deviation = np.ones(10_000)
    deviation[:far] = 100.0
    assert Legend.of(deviation).beyond == said
