"""The inertial room: increments, the one error-state layout, mechanisation, dynamics, propagation."""
