"""The README's picture: a drive and one of its outages, drawn as SVG.

    python docs/make_picture.py

Simulates the drive of the README, fuses it with the inertial sensors alone and with what a car
obeys, and writes `docs/images/outage.svg`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import gapless as gp
from gapless import earth

PICTURE = Path(__file__).parent / "images" / "outage.svg"
WIDTH, HEIGHT, TOP, BOTTOM = 960, 440, 84, 396
INK, FAINT, INS, OURS = "#1f2933", "#7b8794", "#d64545", "#0b69a3"
BEFORE = 8.0
"""Seconds shown before the outage."""
SEMI_AXES = np.sqrt(5.991)
"""Of a 95 % ellipse in standard deviations (chi-square, two degrees of freedom)."""


class Panel:
    """A box of the picture, its scale the same in both directions.

    Parameters
    ----------
    left, right : float
        [px]
    points : ndarray, shape (n, 2)
        North, east [m]; all of them fit.
    """

    def __init__(self, left: float, right: float, points: Any) -> None:
        low, high = points.min(axis=0), points.max(axis=0)
        self.left, self.middle = left, 0.5 * (low + high)
        self.centre = np.array([0.5 * (left + right), 0.5 * (TOP + BOTTOM)])
        self.scale = min((BOTTOM - TOP) / (high[0] - low[0]), (right - left) / (high[1] - low[1]))

    def place(self, points: Any) -> Any:
        """Pixels x, y of points north, east."""
        away = self.scale * (points - self.middle)
        return self.centre + np.column_stack([away[:, 1], -away[:, 0]])

    def line(self, points: Any, style: str) -> str:
        """A path."""
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in self.place(points))
        return f'<polyline points="{path}" {style}/>'

    def dot(self, point: Any, radius: float, colour: str, label: str = "", side: int = 1) -> str:
        """A dot, and what is said of it on its right (1) or left (-1)."""
        x, y = self.place(point[None])[0]
        where = f'x="{x + 10 * side:.0f}" y="{y + 5:.0f}" text-anchor="{"start" if side > 0 else "end"}"'
        text = f'<text {where} fill="{colour}">{label}</text>' if label else ""
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius}" fill="{colour}"/>{text}'

    def ellipse(self, drive: Any, row: Any, colour: str) -> str:
        """The 95 % ellipse of one row of a trajectory."""
        (n, e), both = row.sd[0, :2] ** 2, row.horizontal[0]
        (x, y), (values, axes) = self.place(local(drive, row))[0], np.linalg.eigh([[n, both], [both, e]])
        a, b = SEMI_AXES * self.scale * np.sqrt(values[::-1])
        turn = np.degrees(np.arctan2(-axes[0, 1], axes[1, 1]))
        where = f'cx="{x:.1f}" cy="{y:.1f}" rx="{a:.1f}" ry="{b:.1f}"'
        return (
            f'<ellipse {where} transform="rotate({turn:.0f} {x:.1f} {y:.1f})" '
            f'fill="{colour}" fill-opacity="0.10" stroke="{colour}" stroke-width="0.7"/>'
        )

    def bar(self, metres: float) -> str:
        """A scale bar below."""
        end = self.left + metres * self.scale
        return (
            f'<path d="M{self.left} {BOTTOM + 16}v5H{end:.1f}v-5" stroke="{FAINT}" fill="none"/>'
            f'<text x="{end + 8:.0f}" y="{BOTTOM + 22}" fill="{FAINT}">{metres:.0f} m</text>'
        )


def local(drive: Any, trajectory: Any) -> Any:
    """North, east [m] of a trajectory or of fixes, from where the drive begins."""
    return earth.lla_to_ned(trajectory.lla, drive.reference.lla[0])[:, :2]


def whole_drive(drive: Any, ours: Any) -> list[str]:
    """Left: the drive and its outages."""
    truth = local(drive, drive.reference)[::5]
    panel = Panel(30, 330, truth)
    parts = [panel.line(truth, f'stroke="{FAINT}" stroke-width="1.6"')]
    for begin, end in ours.outages:
        track = local(drive, ours.trajectory.slice(begin, end))[::5]
        parts.append(panel.line(track, f'stroke="{OURS}" stroke-width="5" stroke-linecap="round"'))
    return [*parts, panel.bar(500.0)]


def one_outage(drive: Any, alone: Any, ours: Any, which: int) -> list[str]:
    """Right: truth, both solutions and their ellipses in one outage."""
    begin, end = ours.outages[which]
    truth = local(drive, drive.reference.slice(begin - BEFORE, end))
    rows = [solution.trajectory.slice(begin, end) for solution in (alone, ours)]
    adrift, held = (local(drive, each) for each in rows)
    reach = [
        track + k * SEMI_AXES * each.sd[:, :2]
        for track, each in ((adrift, rows[0]), (held, rows[1]))
        for k in (-1, 1)
    ]
    panel = Panel(400, WIDTH - 40, np.concatenate([truth, *reach]))
    parts = [panel.line(truth[::3], f'stroke="{INK}" stroke-width="8" stroke-opacity="0.22"')]
    for each, colour in zip(rows, (INS, OURS), strict=True):
        parts += [panel.ellipse(drive, each.take([k]), colour) for k in range(149, len(each), 150)]
    parts.append(panel.line(adrift[::3], f'stroke="{INS}" stroke-width="2" stroke-dasharray="7 4"'))
    parts.append(panel.line(held[::3], f'stroke="{OURS}" stroke-width="2.4"'))
    parts += [panel.dot(p, 3.5, INK) for p in local(drive, drive.gnss.slice(begin - BEFORE, begin))]
    side = 1 if adrift[-1, 1] > held[-1, 1] else -1
    for track, colour, solution, at in ((adrift, INS, alone, side), (held, OURS, ours, -side)):
        off = gp.score(solution, drive).outages[which].horizontal_end
        parts.append(panel.dot(track[-1], 4.5, colour, f"{off:.0f} m off", at))
    return [*parts, panel.bar(50.0)]


def legend(ours: Any, which: int) -> list[str]:
    """Titles, and which line is which."""
    begin, end = ours.outages[which]
    words = [(INK, "truth and last fixes"), (INS, "inertial sensors alone"), (OURS, "gapless")]
    parts = [
        f'<text x="{WIDTH - 30}" y="58" text-anchor="end" fill="{FAINT}">ellipses: stated 95 %</text>',
        f'<text x="30" y="34" class="title" fill="{INK}">A drive with three GNSS outages</text>',
        f'<text x="400" y="34" class="title" fill="{INK}">{end - begin:.0f} s without GNSS</text>',
    ]
    for x, (colour, text) in zip((400, 558, 722), words, strict=True):
        parts.append(f'<text x="{x}" y="58" fill="{colour}">{text}</text>')
    return parts


def draw(drive: Any, alone: Any, ours: Any, path: Path = PICTURE) -> None:
    """Draw the outage in which the inertial sensors alone drift farthest.

    Parameters
    ----------
    drive : Recording
        With a reference.
    alone, ours : Solution
        By the inertial sensors alone, and with constraints.
    path : Path
    """
    drift = [outage.horizontal_end for outage in gp.score(alone, drive).outages]
    which = int(np.argmax(drift))
    style = "text{font:14px system-ui,sans-serif} .title{font-size:17px;font-weight:600} polyline{fill:none}"
    parts = [*whole_drive(drive, ours), *one_outage(drive, alone, ours, which), *legend(ours, which)]
    path.parent.mkdir(exist_ok=True)
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}"><style>{style}</style>\n'
        f'<rect width="{WIDTH}" height="{HEIGHT}" rx="10" fill="#fff"/>\n' + "\n".join(parts) + "\n</svg>\n",
        encoding="utf-8",
    )


def main() -> None:
    """The drive of the README, fused twice."""
    drive = gp.simulate_drive("urban", "consumer", duration=800, seed=1)
    outages = gp.plan(["every=180,length=60,first=240"], drive.duration)
    draw(drive, *(gp.fuse(drive, gp.load_system(name), outages) for name in ("ins", "constraints")))


if __name__ == "__main__":
    main()
