"""Episodes in which a human and a robot take turns: worlds, simulated humans, measures."""
