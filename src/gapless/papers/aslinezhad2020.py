"""Aslinezhad, Malekijavan & Abbasi 2020: robust Kalman filter, NAR and feed-forward networks."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from gapless.papers.model import OURS, Drive, Experiment, Faults, Method, Paper, Window
from gapless.papers.published import Claim
from gapless.simulate import Receiver
from gapless.units import DEG

OUTAGE: Final = "17 s"
ON: Final = "GNSS on"
DRIVE: Final = Drive(
    segments="urban",
    grade="adis16448",
    rate=100.0,
    duration=700.0,
    receiver=Receiver(
        rate=1.0,
        position_white=(1.5, 1.5, 2.0),
        position_correlated=(0.0, 0.0, 0.0),
        velocity=(0.05, 0.05, 0.05),
        stated=1.0,
    ),
    windows=(Window(ON, 120.0, 600.0, withheld=False), Window(OUTAGE, 600.0, 617.0)),
    origin=(35.70 * DEG, 51.40 * DEG, 1200.0),
    faults=(Faults(71, (4.0, 8.0)), Faults(34, (8.0, 60.0))),
)
"""700 s in a town, 100 Hz, GNSS lost after 600 s; 71 small and 34 large gross errors, as Figure 7 counts."""

EKF: Final = Method("EKF", "ins", {"adaptation.gnss": []})
GATE: Final = Method("EKF with our gate", "ins")
RKF: Final = Method("RKF", "aslinezhad2020", {"bridge.model": "none"})
FORWARD: Final = Method("RKF + feed-forward", "aslinezhad2020-ff")
NAR: Final = Method("RKF + NAR", "aslinezhad2020")
METHODS: Final = (EKF, RKF, FORWARD, NAR, GATE, Method(OURS, "constraints"))
_AXES: Final = ("north", "east", "down")
_NETWORKS: Final = tuple(
    Claim(f"abstract: {network.name}, at least -67 % per axis", OUTAGE, network.name, RKF.name,
          f"position_{axis}_rmse", 0.33)
    for network in (FORWARD, NAR)
    for axis in _AXES
)  # fmt: skip

PAPER: Final = Paper(
    name="aslinezhad2020",
    title="ANN-assisted robust GPS/INS information fusion to bridge GPS outage",
    citation="M. Aslinezhad, A. Malekijavan, P. Abbasi, EURASIP J. Wireless Com. Network. 2020, 129",
    idea=(
        "Fixes whose innovations are too large by a chi-square test are weighed less, or dropped. While GNSS "
        "speaks, a network learns the errors of the INS: from its outputs (feed-forward), or as a series "
        "that goes on from its own past (NAR). In an outage its predictions take the place of the filter's."
    ),
    experiments=(
        Experiment(
            "simulation",
            "The paper's sensors, rates, length and outage on simulated city drives, with gross errors.",
            METHODS,
            DRIVE,
            claims=(
                *(
                    Claim(
                        "conclusion: RMS position error -5 % by RKF",
                        ON,
                        RKF.name,
                        EKF.name,
                        f"position_{axis}_rmse",
                        0.95,
                    )
                    for axis in _AXES
                ),
                *_NETWORKS,
            ),
            seeds=50,
        ),
        Experiment(
            "clean fixes",
            "The same without gross errors: what robustness costs.",
            (EKF, RKF, GATE),
            replace(DRIVE, faults=()),
            seeds=20,
            aside=True,
        ),
        Experiment(
            "road",
            "The same methods on real recordings, outages of 17 s all along them.",
            METHODS,
            road=(Window(ON, 0.0, 0.0, withheld=False), Window(OUTAGE, 0.0, 17.0)),
            claims=(
                *(
                    Claim(
                        "conclusion: RMS position error -5 % by RKF",
                        ON,
                        RKF.name,
                        EKF.name,
                        f"position_{axis}_rmse",
                        0.95,
                    )
                    for axis in _AXES[:2]
                ),
                *(c for c in _NETWORKS if not c.key.startswith("position_down")),
            ),
        ),
    ),
    open=(
        "The IMU: the ADIS16448's datasheet (grade adis16448). The receiver: an NV08C-CSM, 1.5 m and 0.05 "
        "m/s by its datasheet, white; the paper states neither noise.",
        "Gross errors: the paper counts 71 test values between its thresholds and 34 above them, of a drive "
        "of 700 s; so many fixes are thrown by 4 to 8 m and by 8 to 60 m.",
        "The outage is 14 s, 15 s (1,500 samples) and 17 s in three places of the text: 17 s.",
        "Axes are ECEF in the paper: per axis, here, is north, east and down.",
        "Whether fixes carry velocity: the text leaves it open; they do here.",
        "Table 1 and Table 2 are not in the text; the abstract's figures stand for them.",
    ),
    differs=(
        "An EKF in gapless gates its fixes; the paper's does not, so EKF is run without any adaptation, and "
        "the gate is a row of its own.",
    ),
)
