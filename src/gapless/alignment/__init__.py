"""Finding out where things start: attitude, clocks, mounting."""
