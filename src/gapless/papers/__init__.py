"""The papers' experiments, run again: scenario, methods and published tables as data, ours beside them."""
