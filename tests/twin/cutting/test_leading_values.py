"""The first of the largest values in each list of a ragged array."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from twin.cutting.pairs import leaders

lists = st.lists(st.lists(st.sampled_from([-np.inf, -1.0, 0.0, 2.5]), min_size=1, max_size=5), min_size=1)


@settings(derandomize=True, deadline=None, max_examples=50, database=None)
@given(values=lists)
def test_the_first_of_the_largest_leads_each_list(values):
    flat, length = np.concatenate(values), [len(own) for own in values]
    start = np.concatenate([[0], np.cumsum(length)])
    for owner in (None, np.repeat(np.arange(len(values)), length)):
        largest, first = leaders(flat, start, owner)
        assert largest.tolist() == [max(own) for own in values]
        assert (first - start[:-1]).tolist() == [own.index(max(own)) for own in values]
