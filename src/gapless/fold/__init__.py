"""The fold: events in, belief forward; what it remembers, and what it writes down."""
