"""gapless: GNSS/INS fusion that keeps navigating when GNSS goes silent."""

__version__ = "0.1.0"
