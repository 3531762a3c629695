"""Logs of one trip put together: each made sound, then held against each other."""

from __future__ import annotations

import numpy as np

from gapless.io.edges import FAR, FAR_IMU, of_the_trip, without_strays
from gapless.io.inertial_log import imu_from_increments, imu_from_rates
from gapless.io.leaps import check_positions_go_on, check_sensors_go_on, check_wheels_go_on
from gapless.io.log import Log
from gapless.io.orientation import check_orientation
from gapless.io.other_logs import odometer_from_log, reference_from_log
from gapless.io.plausible import check_odometer
from gapless.io.satellite_log import gnss_from_log
from gapless.io.wraps import unwrapped
from gapless.trip.recording import Array, Imu, Note, Recording


def assemble(
    name: str,
    imu: Log,
    gnss: Log,
    *,
    odometer: Log | None = None,
    reference: Log | None = None,
    axes: Array | None = None,
    lever_arm: Array | None = None,
    grade: str | None = None,
    reference_clock: str | None = None,
) -> Recording:
    """Build a recording from its logs; what is mended is said in its notes.

    Parameters
    ----------
    name : str
        What the user calls it.
    imu : Log
        Of rates (`gyro_x`, ...) or of increments (`dtheta_x`, ...).
    gnss : Log
    odometer, reference : Log, optional
    axes : ndarray, shape (3, 3), optional
        Logged IMU axes to forward-right-down (rates only).
    lever_arm : ndarray, shape (3,), optional
        Antenna from the IMU, FRD [m]; None where nobody told it.
    grade : str, optional
        Named sensor grade.
    reference_clock : str, optional
        "imu" or "gnss"; "gnss" for a reference of positions only (a receiver logged it), else "imu".

    Returns
    -------
    Recording

    Raises
    ------
    RecordingError
        If a log cannot be used, or IMU and GNSS do not overlap in time.
    """
    given = {"imu": imu, "gnss": gnss, "odometer": odometer, "reference": reference}
    logs, notes = unwrapped({sensor: log for sensor, log in given.items() if log is not None})
    imu, gnss, odometer, reference = logs["imu"], logs["gnss"], logs.get("odometer"), logs.get("reference")
    imu = without_strays(imu, FAR_IMU, notes)
    samples, more = imu_from_increments(imu) if "dtheta_x" in imu else imu_from_rates(imu, axes)
    notes += more
    gnss = _tidied(gnss, samples, notes)
    fixes, more = gnss_from_log(gnss)
    notes += more
    check_positions_go_on(gnss, fixes)
    check_sensors_go_on(imu, samples, gnss, fixes)
    wheel = truth = None
    if odometer is not None:
        odometer = _tidied(odometer, samples, notes)
        wheel, more = odometer_from_log(odometer)
        check_wheels_go_on(odometer, wheel, fixes)
        check_odometer(odometer, wheel, fixes)
        notes += more
    if reference is not None:
        truth, more = reference_from_log(_tidied(reference, samples, notes))
        notes += more
        check_positions_go_on(reference, truth)
        if (
            reference_clock is None
            and not np.isfinite(truth.euler).any()
            and not np.isfinite(truth.v_n).any()
        ):
            reference_clock = "gnss"
    _check_overlap(imu, gnss, samples.time, fixes.time)
    check_orientation(imu, samples, fixes, axes)
    return Recording(
        name=name,
        imu=samples,
        gnss=fixes,
        odometer=wheel,
        reference=truth,
        reference_clock=reference_clock or "imu",
        lever_arm=None if lever_arm is None else np.asarray(lever_arm, float),
        grade=grade,
        notes=tuple(notes),
    )


def _tidied(log: Log, imu: Imu, notes: list[Note]) -> Log:
    """Another sensor's log without the stamps that make a drive last for decades."""
    return of_the_trip(without_strays(log, FAR, notes), imu.time, notes)


def _check_overlap(imu: Log, gnss: Log, samples: Array, fixes: Array) -> None:
    """Refuse logs that do not share a second, and guess why."""
    a0, a1, b0, b1 = float(samples[0]), float(samples[-1]), float(fixes[0]), float(fixes[-1])
    inside = int(((fixes >= a0) & (fixes <= a1)).sum())
    if inside >= 2:
        return
    cure = "put both on one clock, or check that they are of one trip"
    weeks = round((b0 - a0) / 604800.0)
    if weeks and abs(b0 - a0 - 604800.0 * weeks) < 0.5 * 604800.0 and min(a0, b0) < 604800.0 < max(a0, b0):
        cure = "one counts from the start of the GPS week, the other does not: put both on one clock"
    scale = (b1 - b0) / (a1 - a0)
    for unit, factor in (("milliseconds", 1e3), ("microseconds", 1e6), ("nanoseconds", 1e9)):
        if 0.3 * factor < scale < 3.0 * factor:
            cure = f"GNSS time looks like {unit}: log seconds"
        if 0.3 / factor < scale < 3.0 / factor:
            cure = f"IMU time looks like {unit}: log seconds"
    gnss.refuse(
        f"{b0:.3f} to {b1:.3f} s does not overlap the IMU's {a0:.3f} to {a1:.3f} s ({imu.where})", cure
    )
