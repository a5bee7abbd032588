"""Goal recognition from costs, for goals that have no plan graphs."""
