"""Liu, Zhang & Zhang 2019: denoising by EMD-CIIT and RVFL, low-cost sensors; a road test, here simulated."""

from __future__ import annotations

from typing import Final

from gapless.papers.model import OURS, Drive, Experiment, Method, Paper, Window
from gapless.papers.published import Claim, Column, Line, Published
from gapless.simulate import Receiver
from gapless.units import DEG

ONE, TWO, THREE = "#1, 120 s", "#2, 120 s", "#3, 120 s"
DRIVE: Final = Drive(
    segments="urban",
    grade="liu2019",
    rate=100.0,
    duration=2400.0,
    receiver=Receiver(
        rate=5.0,
        position_white=(2.5, 2.5, 2.5),
        position_correlated=(0.0, 0.0, 0.0),
        velocity=(0.1, 0.1, 0.1),
        stated=1.0,
    ),
    windows=(
        Window("GNSS on", 300.0, 750.0, withheld=False),
        Window(ONE, 750.0, 870.0),
        Window(TWO, 1450.0, 1570.0),
        Window(THREE, 1950.0, 2070.0),
    ),
    origin=(38.91 * DEG, 121.60 * DEG, 20.0),
)
"""Table 1 and section 5.1: Dalian, 2,400 s, 5 Hz GNSS of 2.5 m, three outages of 120 s."""

ONLY: Final = {"sensors": ["position"]}
"""Eq. 3: position is the only measurement."""
RAW: Final = {**ONLY, "denoise.method": "none"}
INS: Final = Method("Pure INS", "ins", ONLY)
RBN: Final = Method("RBN", "liu2019-rbf", ONLY)
ELM: Final = Method("ELM", "liu2019-elm", ONLY)
RVFL: Final = Method("RVFL", "liu2019", ONLY)
RAW_ELM: Final = Method("ELM, raw", "liu2019-elm", RAW)
RAW_RVFL: Final = Method("RVFL, raw", "liu2019", RAW)
WAVELET_RVFL: Final = Method("RVFL, wavelet", "liu2019-wavelet", ONLY)
METHODS: Final = (
    INS, RBN, ELM, RVFL, RAW_ELM, RAW_RVFL, WAVELET_RVFL, Method(OURS, "constraints", ONLY),
)  # fmt: skip
FED_BACK: Final = {"bridge.features": ["ins_velocity", "force", "rate"]}
CHANNELS: Final = ("f_x", "f_y", "f_z", "w_x", "w_y", "w_z")
SNR: Final = {
    "raw": (-11.38, -2.29, -17.31, -10.36, -12.78, -5.74),
    "wavelet": (-10.25, -1.99, -14.25, -9.83, -12.42, -5.37),
    "EMD": (-5.18, -1.47, -10.78, -9.37, -11.6, -4.85),
}
"""Table 2: signal-to-noise ratios of `CHANNELS` [dB]."""
NORTH_EAST: Final = (Column("N", "position_north_rmse"), Column("E", "position_east_rmse"))

TABLE_3: Final = Published(
    "Table 3",
    "Position RMSE in the outages",
    NORTH_EAST,
    tuple(
        Line(where, method, values)
        for where, of in (
            (ONE, {"Pure INS": (455.1, 258.6), "ELM": (166.5, 71.3), "RVFL": (122.1, 45.1)}),
            (TWO, {"Pure INS": (710.4, 466.2), "ELM": (310.8, 177.6), "RVFL": (266.4, 166.5)}),
            (THREE, {"Pure INS": (843.6, 876.9), "ELM": (288.6, 123.1), "RVFL": (66.7, 66.0)}),
        )
        for method, values in of.items()
    ),
    subject="RVFL",
)
TABLE_4: Final = Published(
    "Table 4",
    "Position RMSE in outage 1",
    NORTH_EAST,
    (Line(ONE, "RBN", (255.3, 60.4)), Line(ONE, "ELM", (166.5, 71.3)), Line(ONE, "RVFL", (122.1, 45.1))),
    subject="RVFL",
)
EAST: Final = "position_east_rmse"
DENOISED: Final = (
    Claim("5.3: east, ELM, -67.5 % by denoising", ONE, "ELM", "ELM, raw", EAST, 71.3 / 219.7),
    Claim("5.3: east, RVFL, -50.1 % by denoising", ONE, "RVFL", "RVFL, raw", EAST, 45.1 / 90.3),
)

PAPER: Final = Paper(
    name="liu2019",
    title="A Robust EMD-Based RVFL Network Fusion Algorithm for Low-Cost GPS/INS Integrated System",
    citation="D. Liu, S. Zhang, J. Zhang, Mathematical Problems in Engineering (Hindawi), 2019",
    idea=(
        "The IMU's channels are first freed of noise by empirical mode decomposition with interval "
        "thresholding. While GNSS speaks, a random-vector functional link network learns the increment of "
        "the position from one fix to the next, given velocity, specific force and angular rate; in an "
        "outage the increments it predicts are summed from the last fix and fed to the filter."
    ),
    experiments=(
        Experiment(
            "simulation",
            "Sensors, rates, length and outages of the paper on simulated city drives, another for each "
            "seed.",
            METHODS,
            DRIVE,
            tables=(TABLE_3, TABLE_4),
            claims=DENOISED,
            seeds=10,
        ),
        Experiment(
            "corrected velocity",
            "The learner is shown the velocity that the filter holds, which its own word has corrected.",
            (
                INS,
                Method("RVFL", "liu2019", {**RAW, **FED_BACK}),
                Method("ELM", "liu2019-elm", {**RAW, **FED_BACK}),
            ),
            DRIVE,
            seeds=3,
            aside=True,
        ),
        Experiment(
            "road",
            "The same methods on real recordings, outages of 120 s all along them.",
            METHODS,
            road=(Window("120 s", 0.0, 120.0),),
            claims=tuple(
                Claim(f"Table 3, mean of three outages: {other} to RVFL", "120 s", "RVFL", other, key, ratio)
                for other, key, ratio in (
                    ("Pure INS", "position_north_rmse", (122.1 + 266.4 + 66.7) / (455.1 + 710.4 + 843.6)),
                    ("Pure INS", "position_east_rmse", (45.1 + 166.5 + 66.0) / (258.6 + 466.2 + 876.9)),
                    ("ELM", "position_north_rmse", (122.1 + 266.4 + 66.7) / (166.5 + 310.8 + 288.6)),
                    ("ELM", "position_east_rmse", (45.1 + 166.5 + 66.0) / (71.3 + 177.6 + 123.1)),
                )
            ),
        ),
    ),
    open=(
        "The drive: our simulated city driving (30 to 60 km/h, lights, turns), another for each seed; in the "
        "paper's drive outages 1 and 3 hold much motion and outage 2 little.",
        "Turn-on biases: as large as the in-run figures of Table 1; their correlation time, 600 s.",
        "What is scored as real time may not see a later sample, so denoising is windowed and causal unless "
        "the recipe says otherwise; the paper denoises the whole record, which sees the outage.",
        "Which INS velocity the network is shown in an outage. The one that its own word has corrected "
        'closes a loop that runs away: see the experiment "corrected velocity". So it is that of an INS '
        "beside the filter that starts anew once a minute and when the outage begins.",
        "GNSS errors of 2.5 m are white at 5 Hz. Those of a real receiver last for a minute.",
    ),
    differs=(
        "The paper's truth is an attitude reference without a stated position accuracy; ours is exact.",
        "An INS whose error after 120 s is 500 to 900 m has attitude errors of degrees at the start of "
        "the outage, or biases that the filter has not found. A filter that is told its sensors' budget does "
        "better, and leaves a bridge less to gain: compare ratios.",
    ),
    studies=("denoised",),
)
