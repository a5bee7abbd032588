"""Measure hrcplan on PDDL of public archives, beside other readers, VAL and planners."""
