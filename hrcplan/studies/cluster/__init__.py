"""Studies on a cluster of Dask: one parent that writes, and workers that run episodes."""
