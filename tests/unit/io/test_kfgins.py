"""KF-GINS-style text: which file is which, the fast way and the careful way, and its refusals."""

import numpy as np
import pytest

from gapless import io
from gapless.errors import RecordingError
from gapless.units import DEG

LAYOUTS = {
    "single blanks": "%.10f",
    "wide": ["%18.10f"] + ["%17.10f"] * 6,
    "commas": "%.10f",
    "tabs": "%.10f",
    "CRLF": "%.10f",
    "exponents": "%.17e",
}


@pytest.fixture
def write_text(increments, tmp_path):
    def write(layout="single blanks", header="", imu=None, gnss=None):
        delimiter = {"commas": ", ", "tabs": "\t"}.get(layout, " ")
        newline = "\r\n" if layout == "CRLF" else "\n"
        imu = increments[0] if imu is None else imu
        gnss = increments[1] if gnss is None else gnss
        np.savetxt(
            tmp_path / "imu.txt",
            imu,
            fmt=LAYOUTS[layout],
            delimiter=delimiter,
            newline=newline,
            header=header,
            comments="",
        )
        np.savetxt(tmp_path / "gnss.txt", gnss, fmt="%.12f")
        return tmp_path / "imu.txt", tmp_path / "gnss.txt"

    return write


def refusal(*paths):
    with pytest.raises(RecordingError) as error:
        io.read(*paths)
    line = str(error.value)
    assert "\n" not in line
    return line


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("swapped", [False, True])
def test_numbers_as_numpy_reads_them(write_text, layout, swapped):
    imu, gnss = write_text(layout)
    r = io.read(*((gnss, imu) if swapped else (imu, gnss)))
    expected = np.loadtxt(imu, delimiter={"commas": ","}.get(layout))
    np.testing.assert_array_equal(r.imu.time, expected[:, 0])  # both parsers round correctly
    np.testing.assert_array_equal(r.imu.dtheta, expected[:, 1:4])
    np.testing.assert_array_equal(r.imu.dvel, expected[:, 4:7])
    fixes = np.loadtxt(gnss)
    np.testing.assert_array_equal(r.gnss.lla[:, 2], fixes[:, 3])
    np.testing.assert_array_equal(r.gnss.v_n, fixes[:, 7:10])
    np.testing.assert_array_equal(r.gnss.sd_velocity, fixes[:, 10:13])
    assert r.imu.dt[0] == np.median(np.diff(expected[:1001, 0]))
    assert (r.name, r.reference) == ("imu", None)


@pytest.mark.parametrize(
    "header", ["# time dtheta dvel", "% a comment\n\n# another", "time dtx dty dtz dvx dvy dvz"]
)
def test_headers(write_text, header):
    r = io.read(*write_text(header=header))
    assert len(r.imu) == 10_000


def test_header_longer_than_the_head(write_text):
    r = io.read(*write_text(header="\n".join(["# " + 78 * "-"] * 2000)))
    assert len(r.imu) == 10_000


def test_comments_and_blank_lines_between_rows(write_text, increments):
    imu, gnss = write_text()
    lines = imu.read_text().splitlines()
    lines[5000:5000] = ["# the driver paused", "", "   "]
    imu.write_text("\n".join(lines))
    np.testing.assert_allclose(io.read(imu, gnss).imu.dtheta, increments[0][:, 1:4], atol=1e-10)  # ten digits
    lines[6000] = lines[6000].replace("0.0", "O.0", 1)
    imu.write_text("\n".join(lines))
    line = refusal(imu, gnss)
    assert "imu.txt:6001: " in line
    assert "is not a number; mend or remove it" in line


def test_seven_columns_of_gnss(write_text, increments):
    imu, gnss = write_text(gnss=increments[1][:, :7])
    r = io.read(gnss, imu)
    assert not r.gnss.has_velocity
    np.testing.assert_allclose(r.gnss.lla[:, 0], increments[1][:, 1] * DEG, atol=1e-13)


def test_increments_after_lost_rows_are_stretched(write_text, increments):
    imu = increments[0]
    kept = np.delete(imu, [500, 501, 7000], axis=0)
    r = io.read(*write_text(imu=kept))
    assert abs(r.imu.dt.sum() - 100.0) < 1e-9  # rounding of stamps of 1e3 s
    # three rows of 10 ms stand for what they and the lost ones measured: gravity's increment in all
    assert abs(r.imu.dvel[:, 2].sum() / -980.0 - 1.0) < 1e-4
    assert any("stretched" in note.what and note.count == 2 for note in r.notes)


def test_increments_of_a_slower_stretch_are_not(write_text, increments):
    imu = increments[0].copy()
    halved = imu[5000:].reshape(-1, 2, 7)
    slow = halved.sum(axis=1)
    slow[:, 0] = halved[:, 1, 0]
    r = io.read(*write_text(imu=np.concatenate([imu[:5000], slow])))
    assert abs(r.imu.dvel[:, 2].sum() / -980.0 - 1.0) < 1e-4
    assert not any("stretched" in note.what for note in r.notes)


def test_refusals(write_text, increments):
    imu, gnss = write_text()
    text = imu.read_text().splitlines()
    cut = [*text[:300], text[300][:40]]
    imu.write_text("\n".join(cut))
    assert "imu.txt:301: " in (line := refusal(imu, gnss))
    assert "columns where 7 are expected" in line
    imu.write_text("\n".join([*text[:20], text[15], *text[20:]]))
    assert any("repeat one before" in note.what for note in io.read(imu, gnss).notes)
    imu.write_text("\n".join([*text[:5000], *(line.replace(" 0.", " 0.0", 1) for line in text[4000:])]))
    assert "imu.txt:5001: the clock starts anew or was set back here" in refusal(imu, gnss)
    imu.write_text(text[0])
    assert "imu.txt: one row of data" in refusal(imu, gnss)
    imu.write_text("\n".join(line + " 1.0" for line in text[:50]))
    assert "imu.txt:1: 8 columns; make them 7 (time, dtheta_x" in refusal(imu, gnss)
    assert "not a format" in refusal(imu)
    swapped = increments[0][:, [0, 4, 5, 6, 1, 2, 3]]
    assert "exchange the gyro and accelerometer columns" in refusal(*write_text(imu=swapped))
    late = increments[1] + [1e5, *[0.0] * 12]
    assert "gnss.txt: 101000.200 to 101099.800 s does not overlap" in refusal(*write_text(gnss=late))


def test_two_rates_in_one_log_do_not_confuse_which_is_which(write_text, increments):
    """Seven columns each, and the GNSS file the longer one."""
    imu, gnss = increments[0][4000:4400], increments[1][:, :7]
    r = io.read(*write_text(imu=imu, gnss=gnss))
    assert (len(r.imu), len(r.gnss)) == (400, 499)
