"""The page of a bench: leaderboard, pairs, outages one by one, all from its folder of results."""

from gapless.reports.bench.report import write_bench_report

__all__ = ["write_bench_report"]
