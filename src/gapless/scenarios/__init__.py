"""Outage plans: which stretches of a recording lose their GNSS, and what is left of it.

Times are seconds after the first IMU sample. A GNSS epoch whose logged time lies in [start, end) is
withheld, position and velocity both, if the outage has no other effect. `text` has the forms in which
a plan is written.
"""

from gapless.scenarios.effects import KINDS, SILENT, Effect
from gapless.scenarios.outage import Drive, Outage, withheld, withhold
from gapless.scenarios.plans import PLACES, At, Gaps, Periodic, Plan, Random
from gapless.scenarios.text import parse, plan

__all__ = [
    "KINDS",
    "PLACES",
    "SILENT",
    "At",
    "Drive",
    "Effect",
    "Gaps",
    "Outage",
    "Periodic",
    "Plan",
    "Random",
    "parse",
    "plan",
    "withheld",
    "withhold",
]
