import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from twin.inspection.components import components


@given(count=st.integers(1, 60), data=st.data())
def test_components_are_scipys(count, data):
    node = st.integers(0, count - 1)
    edges = np.array(data.draw(st.lists(st.tuples(node, node), max_size=80)), dtype=np.int64).reshape(-1, 2)
    label = components(count, edges[:, 0], edges[:, 1])
    graph = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    number, wanted = connected_components(graph, directed=False)
    assert label.max() + 1 == number
    # the same partition: a label of one stands for one label of the other
    assert len({*zip(label.tolist(), wanted.tolist(), strict=True)}) == number
    first = [int(np.argmax(label == k)) for k in range(number)]
    assert first == sorted(first)
