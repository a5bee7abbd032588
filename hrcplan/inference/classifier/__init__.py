"""The random forest of the changed-mind paper: training, evaluation, cache."""
