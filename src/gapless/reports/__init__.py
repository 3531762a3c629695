"""What a run found, for people: one HTML page, one summary."""

from gapless.reports.report import write_report
from gapless.reports.summary import summarise
from gapless.reports.terminal import summary_lines

__all__ = ["summarise", "summary_lines", "write_report"]
