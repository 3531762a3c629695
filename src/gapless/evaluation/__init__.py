"""Scoring a solution: errors against a truth, outages one by one, statistics over them."""

from gapless.evaluation.ages import QUANTITIES, Ages, ages
from gapless.evaluation.errors import Errors, solution_errors
from gapless.evaluation.outages import OutageScore, score_outage, score_outages
from gapless.evaluation.scores import Accuracy, Scores, outage_ages, pool_spread, score, score_pieces
from gapless.evaluation.statistics import Consistency, Spread, consistency, nees, spread
from gapless.filters.quantile import chi_square_quantile
from gapless.trip.motion import first_motion

__all__ = [
    "QUANTITIES",
    "Accuracy",
    "Ages",
    "Consistency",
    "Errors",
    "OutageScore",
    "Scores",
    "Spread",
    "ages",
    "chi_square_quantile",
    "consistency",
    "first_motion",
    "nees",
    "outage_ages",
    "pool_spread",
    "score",
    "score_outage",
    "score_outages",
    "score_pieces",
    "solution_errors",
    "spread",
]
