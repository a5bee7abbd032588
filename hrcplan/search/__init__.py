"""Heuristics and searches over the steps of a task."""
