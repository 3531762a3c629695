"""Scoring a solution: errors against a truth, outages one by one, statistics over them."""

from gapless.evaluation.errors import Errors, solution_errors
from gapless.evaluation.outages import OutageScore, score_outage, score_outages
from gapless.evaluation.scores import Accuracy, Scores, pool_spread, score
from gapless.evaluation.statistics import Consistency, Spread, chi_square_quantile, consistency, nees, spread
from gapless.motion import first_motion

__all__ = [
    "Accuracy",
    "Consistency",
    "Errors",
    "OutageScore",
    "Scores",
    "Spread",
    "chi_square_quantile",
    "consistency",
    "first_motion",
    "nees",
    "pool_spread",
    "score",
    "score_outage",
    "score_outages",
    "solution_errors",
    "spread",
]
