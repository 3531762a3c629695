"""Bridges: sensors that learn while GNSS speaks and speak while it is silent; one kind a file."""
