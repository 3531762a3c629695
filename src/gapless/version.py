"""The version: what every result says it was made with."""

__version__ = "0.1.0"
