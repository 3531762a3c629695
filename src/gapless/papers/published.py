"""What a paper printed: columns and lines of its tables, and ratios that it states."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, NamedTuple

UNITS: Final = MappingProxyType(
    {"position": "m", "horizontal": "m", "spatial": "m", "velocity": "m/s", "attitude": "deg"}
)
"""Units of measured quantities by the first word of their key."""


class Column(NamedTuple):
    """A column of a table.

    Parameters
    ----------
    title : str
    key : str
        Of what is measured: quantity, axis where there is one, statistic; "position_east_rmse".
    """

    title: str
    key: str

    @property
    def unit(self) -> str:
        """Its unit."""
        return UNITS[self.key.split("_")[0]]


class Line(NamedTuple):
    """A row of a published table.

    Parameters
    ----------
    where : str
        Name of a window.
    method : str
    values : tuple of float
        One for each column; NaN where the paper gives none.
    """

    where: str
    method: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class Published:
    """A table as it was printed.

    Parameters
    ----------
    label : str
        "Table 5".
    title : str
    columns : tuple of Column
    lines : tuple of Line
    subject : str
        The paper's own method, which the others are compared with.
    """

    label: str
    title: str
    columns: tuple[Column, ...]
    lines: tuple[Line, ...]
    subject: str


@dataclass(frozen=True)
class Claim:
    """A ratio that a paper states or that its tables give.

    Parameters
    ----------
    text : str
        Where it stands.
    where : str
        Name of a window.
    better, worse : str
        Methods.
    key : str
        Of what is measured.
    ratio : float
        Better over worse, as published.
    """

    text: str
    where: str
    better: str
    worse: str
    key: str
    ratio: float


RMSE_EN: Final = (
    Column("vE", "velocity_east_rmse"),
    Column("vN", "velocity_north_rmse"),
    Column("pE", "position_east_rmse"),
    Column("pN", "position_north_rmse"),
)
"""East and north velocity and position, RMSE."""
