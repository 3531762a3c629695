"""What a trip measured, how it moved, and what a run found of it."""
