"""The filter room: it knows an error vector and a covariance, not an INS."""
