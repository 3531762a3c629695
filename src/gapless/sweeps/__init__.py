"""Studies of many runs: what to do, who does it, and rows that survive whatever ends it."""
