"""Connected components of a graph, in plain numpy: half a second sooner at hand than scipy's."""

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]


def components(count: int, first: Ints, second: Ints) -> Ints:
    """Label (count,) the nodes of a graph with edges first-second (n,): 0, 1, … by least member."""
    label = np.arange(count)
    while True:
        a, b = label[first], label[second]
        apart = a != b
        if not apart.any():
            return (np.cumsum(label == np.arange(count)) - 1)[label]
        # only edges between different trees are looked at again, each hooks the higher root on the lower
        first, second, a, b = first[apart], second[apart], a[apart], b[apart]
        # of several edges of one tree any may win: the next turn looks at the others again
        label[np.maximum(a, b)] = np.minimum(a, b)
        while not np.array_equal(above := label[label], label):
            label = above
