"""A recording through a system: what is decided first, the fold, what is told of it."""
