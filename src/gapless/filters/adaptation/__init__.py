"""How R bends to what an observation says: one rule a file."""
