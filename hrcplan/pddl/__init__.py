"""PDDL files: reading with positions, checking, the shipped library, and writing."""
