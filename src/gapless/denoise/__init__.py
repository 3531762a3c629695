"""Denoising of inertial signals: of a whole record, or window by window from the past alone."""
