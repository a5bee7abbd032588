"""Types of numpy arrays, named once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
"""Indices: of nodes, edges, goals, labels."""
SmallIds = NDArray[np.int32]
"""Indices that are stored many times: the steps and targets of edges, steps of plans."""
Bools = NDArray[np.bool_]
Words = NDArray[np.uint64]
"""Bit sets as rows of 64-bit words."""
Rows = NDArray[np.uint8]
"""Counts of steps, one row per history."""
