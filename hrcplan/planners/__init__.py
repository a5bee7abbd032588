"""Planners: adapters, our own exact search, and one checked result type."""
