"""The receding-horizon planner of the changed-mind paper, part by part."""
