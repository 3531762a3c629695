from dataclasses import replace

from gapless.papers.model import Drive, Experiment, Method, Paper, Start, Window
from gapless.papers.published import Claim, Column, Line, Published
from gapless.simulate import Receiver
from gapless.units import DEG

DRIVE = Drive(
    segments="urban",
    grade="consumer",
    rate=50.0,
    duration=150.0,
    receiver=Receiver(),
    windows=(Window("GNSS on", 60.0, 110.0, withheld=False), Window("15 s", 110.0, 125.0)),
)
TABLE = Published(
    "Table 1",
    "RMSE",
    (Column("pE", "position_east_rmse"), Column("pN", "position_north_rmse")),
    (
        Line("15 s", "INS", (4.0, 3.0)),
        Line("15 s", "car", (2.0, 1.5)),
        Line("15 s", "dream", (1.0, 1.0)),
        Line("GNSS on", "car", (0.5, float("nan"))),
    ),
    subject="car",
)
METHODS = (Method("INS", "ins"), Method("car", "constraints"), Method("dream", "ins", {"filter.dream": 1}))


def experiment(**changes):
    return replace(Experiment("town", "A town.", METHODS, DRIVE, tables=(TABLE,), seeds=2), **changes)


def small_paper():
    aside = experiment(name="given start", drive=replace(DRIVE, start=Start(0.01 * DEG)), seeds=1, aside=True)
    told = experiment(claims=(Claim("text: half", "15 s", "car", "INS", "horizontal_max", 0.5),))
    road = experiment(name="road", drive=None, road=(Window("15 s", 0.0, 15.0),), tables=())
    return Paper("small", "A title", "N. Obody, 2020", "An idea.", (told, aside, road), ("Open.",), ("Why.",))
