"""`gapless simulate`: a recording of a drive that never was, with its truth."""

from __future__ import annotations

from pathlib import Path

import click

from gapless.cli.options import force_option, out_option, outage_options
from gapless.cli.screen import say


@click.command(short_help="Simulate a drive, as a recording with its truth.")
@click.option(
    "--profile",
    default="urban",
    show_default=True,
    metavar="NAME",
    help="How it is driven: carpark, highway, mixed, static, urban or wang2018.",
)
@click.option(
    "--grade",
    default="consumer",
    show_default=True,
    metavar="NAME",
    help="The IMU: perfect, consumer, liu2019, adis16448, span-cpt, wang2018, tactical or navigation.",
)
@click.option(
    "--duration", type=float, default=1800.0, show_default=True, metavar="SECONDS", help="At most this long."
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=1,
    show_default=True,
    metavar="N",
    help="The same seed gives the same drive.",
)
@click.option(
    "--mounting",
    type=(float, float, float),
    default=(0.0, 0.0, 0.0),
    metavar="ROLL PITCH YAW",
    help="How the IMU's box is turned in the car, in degrees.",
)
@click.option("--late", type=float, default=0.0, metavar="SECONDS", help="By how much GNSS stamps are late.")
@click.option("--odometer", is_flag=True, help="Log wheel speed as well.")
@click.option(
    "--wheels",
    type=float,
    metavar="FACTOR",
    help="Shake the car by tyres, engine and road, not by the grade's noise; the tyres FACTOR times as "
    "loud as those of a passenger car.",
)
@outage_options
@out_option
@force_option
def simulate(
    profile: str,
    grade: str,
    duration: float,
    seed: int,
    mounting: tuple[float, float, float],
    late: float,
    odometer: bool,
    wheels: float | None,
    outage: tuple[str, ...],
    outages: tuple[str, ...],
    out: Path,
    force: bool,
) -> None:
    """Simulate a drive: IMU, GNSS and the truth, as a recording folder.

    With --outage or --outages the receiver itself is silent, as in a tunnel. A
    recording that DIR holds already is kept, but for one of the same options.
    """
    from gapless.cli.output import check_recording, digest, write_together

    chosen = {k: v for k, v in click.get_current_context().params.items() if k not in ("out", "force")}
    origin = digest("simulate", sorted(chosen.items()))
    check_recording(out, origin, force)

    from dataclasses import replace

    from gapless.cli.describe import describe
    from gapless.io.writers.recording import check_free, recording_files
    from gapless.scenarios import plan, withhold
    from gapless.simulate import CAR, Receiver, Vehicle, WheelSensor
    from gapless.simulate import simulate as drive
    from gapless.units import DEG

    made = drive(
        profile,
        grade,
        duration,
        seed,
        vehicle=Vehicle(mounting=(mounting[0] * DEG, mounting[1] * DEG, mounting[2] * DEG)),
        receiver=Receiver(position_delay=late, velocity_delay=late),
        wheels=WheelSensor() if odometer else None,
        chassis=None if wheels is None else replace(CAR, signal=wheels),
    )
    silent = plan([*outage, *outages], made)
    made = replace(made, gnss=withhold(made.gnss, silent, made.start))
    files = recording_files(made, origin)
    check_free(out, files)
    write_together(out, files)
    say(*describe(made), "", f"wrote {out}")
