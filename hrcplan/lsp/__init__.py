"""A language server for PDDL: what editors show while a file is written."""
