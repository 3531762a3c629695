"""Sensor models: a belief and a reading in, an observation (z, H, R) out; one sensor a file."""
