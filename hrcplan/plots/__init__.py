"""Pictures of plans, beliefs and studies, in one style."""
