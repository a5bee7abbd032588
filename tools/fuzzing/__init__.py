"""Mutated inputs of every kind: whatever comes in, only errors of hrcplan come out, and soon."""
