"""Numbers as text against Python's own formatting."""

from decimal import Decimal

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from twin.output.numerals import rows_of_text

WHOLE = st.integers(-(2**40), 2**40)


@given(st.lists(st.tuples(WHOLE, st.integers(0, 12)), min_size=1, max_size=20))
def test_whole_numbers(rows):
    text = rows_of_text(np.array(rows), (b"<", b"|", b">\n"))
    assert text.decode() == "".join(f"<{a}|{b}>\n" for a, b in rows)


@given(st.lists(WHOLE, min_size=1, max_size=20), st.integers(1, 6))
def test_decimals(numbers, decimals):
    text = rows_of_text(np.array(numbers)[:, None], (b"", b" "), decimals)
    assert text.decode().split() == [f"{Decimal(n).scaleb(-decimals):.{decimals}f}" for n in numbers]
