"""A made-up bench folder: errors that grow with the age of an outage, and ellipses that state them.

Nothing of gapless's bench is in it; only the contract of the folder's files.
"""

from __future__ import annotations

import json
import zlib

import fake_drive
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from scipy.stats import wilcoxon

from gapless import earth

SYSTEMS = {
    "ins": ("inertial sensors alone", True, 0.09, 1.55),
    "constraints": ("stops, no side slip", True, 0.07, 1.05),
    "smoothed": ("as constraints, and looks back from the end", False, 0.05, 0.7),
}
QUANTITIES = ("horizontal", "vertical", "along", "cross", "velocity", "heading_deg")
BASE = "ins"
LABELS = ("no motion", "before motion + 30 s")


def make(
    folder,
    recordings=("kestrel-avenue", "harbour-loop"),
    systems=tuple(SYSTEMS),
    protocols=("passes", "isolated"),
    lengths=(10, 30, 60, 120),
    shifts=(0, 60),
    duration=1500.0,
):
    """Write the folder's files."""
    folder.mkdir(parents=True, exist_ok=True)
    outages, ages, tracks, runs, facts = [], [], [], [], []
    for k, recording in enumerate(recordings):
        t, ned, v_n, _ = fake_drive.drive(duration, np.random.default_rng(8 + k))
        lla = earth.ned_to_lla(ned, _origin(k))
        deg = np.degrees(lla[:, :2])
        _add(tracks, t[::5], deg[::5], recording, "truth", "", "", np.nan, np.full((len(t[::5]), 3), np.nan))
        facts.append(
            {
                "name": recording,
                "duration": duration,
                "distance": float(np.hypot(*v_n[:, :2].T).sum() * 0.1),
                "imu_rate": 100.0,
                "gnss_rate": 1.0,
                "truth": "the recording's reference",
            }
        )
        for protocol in protocols:
            for length in lengths:
                for shift in shifts:
                    _scenario(
                        (outages, ages, tracks), recording, systems, protocol, length, shift, (t, ned, v_n)
                    )
                    for name in systems:
                        runs.append(_run(recording, name, protocol, length, shift))
    _write(folder / "outages.parquet", outages)
    pq.write_table(pa.concat_tables([pa.table(a) for a in ages]), folder / "ages.parquet")
    pq.write_table(pa.concat_tables([pa.table(a) for a in tracks]), folder / "tracks.parquet")
    _write(folder / "runs.parquet", runs)
    board = _leaderboard(outages, recordings, systems, protocols, lengths)
    _write(folder / "leaderboard.parquet", board)
    _write(folder / "pairs.parquet", _pairs(outages, systems, protocols, lengths))
    lines = [f"{r['protocol']} {r['length']:g} s {r['system']}: {r['median']:.2f} m" for r in board]
    (folder / "tables.txt").write_text("\n".join(lines) + "\n", "utf-8")
    bench = {
        "gapless": "0.1.0",
        "arguments": {"recordings": list(recordings), "systems": ",".join(systems)},
        "recordings": facts,
        "systems": [{"name": s, "description": SYSTEMS[s][0], "causal": SYSTEMS[s][1]} for s in systems],
        "protocols": list(protocols),
        "lengths": list(lengths),
        "shifts": list(shifts),
        "prefix": {
            s: dict.fromkeys(
                recordings, "held in 28 outages" if SYSTEMS[s][1] else "declared not causal; not checked"
            )
            for s in systems
        },
        "seconds": 83.4,
    }
    (folder / "bench.json").write_text(json.dumps(bench), "utf-8")
    return folder


def _origin(k):
    return fake_drive.ORIGIN + np.array([0.02 * k, 0.0, 0.0])


def _write(path, rows):
    pq.write_table(pa.Table.from_pylist(rows), path)


def _add(tracks, t, deg, recording, kind, protocol, scenario, start, ellipse):
    n = len(t)
    tracks.append(
        {
            "recording": [recording] * n,
            "kind": [kind] * n,
            "protocol": [protocol] * n,
            "scenario": [scenario] * n,
            "start": np.full(n, start),
            "time": t,
            "lat": deg[:, 0],
            "lon": deg[:, 1],
            "semi_major": ellipse[:, 0],
            "semi_minor": ellipse[:, 1],
            "direction": ellipse[:, 2],
        }
    )


def _scenario(out, recording, systems, protocol, length, shift, drive):
    t, _, v_n = drive
    scenario = f"every=180,length={length},first=240,shift={shift}"
    for start in np.arange(240.0 + shift, t[-1] - length, 180.0):
        rows = np.flatnonzero((t >= start) & (t < start + length))[:: 10 if length > 30 else 5]
        moved = float(np.hypot(*v_n[rows, :2].T).mean() * length)
        label = LABELS[0] if moved < 20 else LABELS[1] if start < 250 and recording.startswith("h") else ""
        for name in systems:
            seed = zlib.crc32(f"{recording}{name}{length}{start}".encode())
            _outage(
                out,
                recording,
                name,
                protocol,
                scenario,
                (start, length, shift, label, moved),
                rows,
                drive,
                seed,
            )


def _outage(out, recording, name, protocol, scenario, facts, rows, drive, seed):
    outages, ages, tracks = out
    (t, ned, v_n), (start, length, shift, label, moved) = drive, facts
    rng = np.random.default_rng(seed)
    _, _, size, power = SYSTEMS[name]
    age = t[rows] - start
    heading = np.arctan2(v_n[rows, 1], v_n[rows, 0])
    spread = np.column_stack([0.4 + size * age**power, 0.35 + 0.6 * size * age**power])
    wander = np.cumsum(rng.standard_normal((len(age), 2)), axis=0) / np.sqrt(len(age))
    along, cross = (spread * (rng.standard_normal(2) * 0.8 + 0.4 * wander)).T
    one = {
        "horizontal": np.hypot(along, cross),
        "vertical": 0.02 * age * rng.standard_normal() + 0.3,
        "along": along,
        "cross": cross,
        "velocity": 0.04 + 0.01 * age * abs(rng.standard_normal()),
        "heading_deg": 0.2 + 0.02 * age * rng.standard_normal(),
    }
    bound = 2.4477 * spread.max(axis=1)
    n, keys = len(age), {"recording": recording, "system": name, "protocol": protocol, "scenario": scenario}
    ages.append(
        {k: [v] * n for k, v in keys.items()}
        | {"start": np.full(n, start), "age": age}
        | one
        | {"bound": bound}
    )
    c, s = np.cos(heading), np.sin(heading)
    north, east = c * along - s * cross, s * along + c * cross
    k = int(recording.startswith("h"))
    lla = earth.ned_to_lla(ned[rows] + np.column_stack([north, east, 0 * north]), _origin(k))
    ellipse = np.column_stack([2.4477 * spread, np.pi / 2 - heading])
    _add(tracks, t[rows], np.degrees(lla[:, :2]), recording, name, protocol, scenario, start, ellipse)
    inside = one["horizontal"] < bound
    row = keys | {
        "group": f"{length:g} s",
        "length": float(length),
        "shift": float(shift),
        "start": start,
        "end": start + length,
        "labels": label,
        "truth": "reference",
        "truth_epochs": n,
        "distance": moved,
    }
    for q in QUANTITIES:
        x = np.abs(one[q])
        row |= {f"{q}_max": x.max(), f"{q}_rmse": np.sqrt((x**2).mean()), f"{q}_end": x[-1]}
    row |= {
        "percent": 100 * row["horizontal_max"] / moved if moved > 1 else np.nan,
        "coverage_50": float((one["horizontal"] < bound / 2.08).mean()),
        "coverage_95": float(inside.mean()),
        "coverage_99": float((one["horizontal"] < bound * 1.24).mean()),
        "nees": float((one["horizontal"] ** 2 / (bound / 2.4477) ** 2).mean() * 2),
        "inside_95_end": float(inside[-1]),
    }
    outages.append({k: v.item() if isinstance(v, np.generic) else v for k, v in row.items()})


def _run(recording, name, protocol, length, shift):
    decisions = [
        {"name": d.name, "value": d.value, "unit": d.unit, "source": d.source, "evidence": d.evidence}
        for d in fake_drive.DECISIONS
    ]
    biases = {
        "gyro_bias": {
            "unit": "deg/s",
            "axes": ["forward", "right", "down"],
            "value": [0.12, -0.05, 0.02 + 0.001 * length],
            "sd": [0.004, 0.004, 0.003],
        }
    }
    channel = {"count": 1200, "dof": 3, "mean_nis": 1.13, "lower": 0.95, "upper": 1.05}
    channel |= {"median_nis": 0.98, "within_95": 0.93, "inflated": 7, "rejected": 2}
    return {
        "recording": recording,
        "system": name,
        "protocol": protocol,
        "scenario": f"every=180,length={length},first=240,shift={shift}",
        "decisions": json.dumps(decisions),
        "biases": json.dumps(biases),
        "innovations": json.dumps({"position": channel, "velocity": channel}),
        "rmse_open": 0.61,
        "coverage_open_95": 0.94,
    }


def _statistics(x):
    return np.array([np.median(x), np.sqrt((x**2).mean()), np.percentile(x, 95), x.max()])


def _leaderboard(outages, recordings, systems, protocols, lengths):
    rng, rows = np.random.default_rng(3), []
    for recording in ("pooled", *(recordings if len(recordings) > 1 else ())):
        for protocol in protocols:
            for length in lengths:
                for name in systems:
                    mine = [
                        o
                        for o in outages
                        if (o["protocol"], o["length"], o["system"]) == (protocol, length, name)
                        and recording in ("pooled", o["recording"])
                    ]
                    x = np.array([o["horizontal_max"] for o in mine if not o["labels"]])
                    if not len(x):
                        continue
                    again = np.array([_statistics(rng.choice(x, len(x))) for _ in range(100)])
                    row = {"recording": recording, "protocol": protocol}
                    row |= {"group": f"{length:g} s", "length": float(length)}
                    row |= {"system": name, "n": len(x), "left_out": len(mine) - len(x)}
                    stated = zip(
                        ("median", "rms", "p95", "worst"),
                        _statistics(x),
                        np.percentile(again, [2.5, 97.5], axis=0).T,
                        strict=True,
                    )
                    for key, value, (lo, hi) in stated:
                        row |= {key: float(value), f"{key}_lo": float(lo), f"{key}_hi": float(hi)}
                    for level in (50, 95, 99):
                        row[f"coverage_{level}"] = float(
                            np.mean([o[f"coverage_{level}"] for o in mine if not o["labels"]])
                        )
                    rows.append(row)
    return rows


def _pairs(outages, systems, protocols, lengths):
    rows = []
    for protocol in protocols:
        for length in lengths:

            def series(name, protocol=protocol, length=length):
                return np.array(
                    [
                        o["horizontal_max"]
                        for o in outages
                        if (o["protocol"], o["length"], o["system"], o["labels"])
                        == (protocol, length, name, "")
                    ]
                )

            for name in systems:
                if name == BASE or BASE not in systems:
                    continue
                ratio = series(name) / series(BASE)
                half = 1.96 * np.log(ratio).std() / np.sqrt(len(ratio))
                p = float(wilcoxon(np.log(ratio)).pvalue)
                mean = float(np.exp(np.log(ratio).mean()))
                rows.append(
                    {
                        "recording": "pooled",
                        "protocol": protocol,
                        "group": f"{length:g} s",
                        "length": float(length),
                        "system": name,
                        "base": BASE,
                        "n": len(ratio),
                        "median_ratio": float(np.median(ratio)),
                        "geometric": mean,
                        "geometric_lo": mean * float(np.exp(-half)),
                        "geometric_hi": mean * float(np.exp(half)),
                        "better": float((ratio < 1).mean()),
                        "worst_ratio": float(ratio.max()),
                        "p": p,
                        "p_corrected": min(1.0, p * (len(systems) - 1)),
                    }
                )
    return rows
