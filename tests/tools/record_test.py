"""gaitpad record, monitor and live decode with a recording as the pad."""
import json
import signal
import subprocess

import pytest

from support.program import ROOT, ROUND, end_by, wait_until_recorded
from support.traces import beginning, lines, ramp, reports, write_trace

DUALSHOCK = ROOT / "tests/data/pads/054c_09cc.hid"


def bytes_of(path):
    return [data for _, data in reports(path)]


@pytest.fixture
def out(tmp_path):
    (tmp_path / "out").mkdir()
    return tmp_path / "out/out.hid"


@pytest.fixture
def trace(tmp_path):
    """The first two seconds of the bundled recording."""
    path = tmp_path / "short.hid"
    path.write_text(beginning(ROUND, 2))
    return path


def test_has_the_same_reports_descriptor_and_times_and_replays(run, trace, out):
    told = json.loads(run("record", trace, "--out", out, "--json").stdout)
    assert bytes_of(out) == bytes_of(trace)
    assert lines(out, "RI") == lines(trace, "RI")
    assert (told["reports"], told["lost"]) == (len(reports(trace)), 0)
    assert (told["vendor"], told["product"]) == (0x1209, 0x0001)
    mine, theirs = ([time_s for time_s, _ in reports(path)] for path in (out, trace))
    for a, b in list(zip(mine, theirs))[1:]:  # the first reports may be late on a busy machine
        assert mine[-1] - a == pytest.approx(theirs[-1] - b, abs=0.0015)
    run("replay", out)
    run("decode", out)


def test_real_pads_keep_every_byte(run, out):
    run("record", DUALSHOCK, "--out", out)
    assert bytes_of(out) == bytes_of(DUALSHOCK)


def test_a_signal_and_seconds_leave_a_complete_file(run, started, out):
    with started("record", ROUND, "--out", out) as process:
        wait_until_recorded(out)
        text, _ = end_by(process, signal.SIGINT)
    assert "reports" in text
    count, all_of_them = len(reports(out)), bytes_of(ROUND)
    assert 10 < count < len(all_of_them) and bytes_of(out) == all_of_them[:count]
    run("replay", out)
    run("record", ROUND, "--out", out, "--seconds", "1.5")
    assert len(reports(out)) < len(all_of_them)
    assert [p.name for p in out.parent.iterdir()] == ["out.hid"]


def test_a_full_disk_ends_it_and_leaves_what_was_written(program, run, out):
    command = f'ulimit -f 2; exec "{program}" record "{ROUND}" --out "{out}" --seconds 60'
    done = subprocess.run(["sh", "-c", command], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                          timeout=50)  # the command ends long before its 60 seconds
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == f"gaitpad record: {out}.part: cannot be written: File too large\n"
    run("replay", f"{out}.part")


def test_without_a_pad_nothing_is_written(run, out):
    out.write_text("kept")
    run("record", "no such pad", "--out", out, "--seconds", "0.5", status=1)
    assert out.read_text() == "kept"
    assert [p.name for p in out.parent.iterdir()] == ["out.hid"]


def test_wrong_usage_is_2_and_what_cannot_be_is_1(run, tmp_path):
    run("record", ROUND, status=2)
    done = run("record", ROUND, "--out", tmp_path / "no/out.hid", status=1)
    assert done.stdout == "" and "no/out.hid" in done.stderr


def test_monitor_prints_an_object_a_second_with_rate_and_latency(run):
    rows = [json.loads(line) for line in run("monitor", ROUND, "--seconds", "3.5", "--json").stdout.splitlines()]
    assert len(rows) >= 3
    for row in rows:
        assert {"device", "name", "rate_hz", "jitter_us", "longest_gap_us", "latency_us_median", "latency_us_max", "lost",
                "axes", "sticks", "triggers", "buttons", "battery", "gyro"} <= set(row)
        assert row["name"] == "Example Walk Pad"
    assert max(row["rate_hz"] for row in rows) > 15
    assert rows[-1]["sticks"]["left"][1] > 0.5  # the stick is pushed forward from the second second on


def dualsense_at_rest(path, seconds=3):
    """A DualSense Edge on Bluetooth that lies still: 16, -32, 0 counts of 2048 / 32767 degrees a second, 250 reports a second."""
    head = [line for line in (ROOT / "tests/data/pads/054c_0df2.hid").read_text().splitlines() if line[0] in "RNI"]
    report = bytearray(78)
    report[0:12] = bytes.fromhex("311080808080000055080000")
    for k, counts in enumerate((16, -32, 0)):
        report[17 + 2 * k:19 + 2 * k] = counts.to_bytes(2, "little", signed=True)
    path.write_text("\n".join(head) + "\n" + "".join(
        f"E: {t // 1000:06}.{t % 1000 * 1000:06} 78 {report.hex(' ')}\n" for t in range(0, 1000 * seconds, 4)))
    return path


def test_monitor_shows_rate_bias_and_noise_of_a_gyroscope_at_rest(run, tmp_path):
    pad = dualsense_at_rest(tmp_path / "still.hid")
    rows = [json.loads(line) for line in run("monitor", pad, "--seconds", "3", "--json").stdout.splitlines()]
    gyro = rows[-1]["gyro"]
    assert abs(gyro["rate_hz"] - 250) < 25 and gyro["rest_s"] > 0.4 and gyro["factory_calibration"] is False
    assert gyro["bias_deg_s"] == pytest.approx([1.0, -2.0, 0.0], abs=0.001) == gyro["deg_s"]
    assert gyro["noise_deg_s"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    assert " Hz +1.00 -2.00 +0.00 noise 0.00 deg/s" in run("monitor", pad, "--seconds", "3").stdout
    assert json.loads(run("monitor", ROUND, "--seconds", "1.2", "--json").stdout.splitlines()[0])["gyro"] is None


def test_monitor_prints_a_line_a_second_where_there_is_no_terminal(run):
    done = run("monitor", ROUND, "--seconds", "2.5")
    assert len(done.stdout.splitlines()) >= 2
    assert "\033" not in done.stdout
    assert done.stderr == ("gaitpad monitor: Example Walk Pad (recording): calibration "
                           "\"unknown stick, not calibrated\"\n")


def test_a_given_calibration_is_used_and_the_recording_holds_it(run, tmp_path, out):
    path = tmp_path / "c.toml"
    path.write_text('name = "turned"\n[left]\nforward = "-y"\n[left_trigger]\nreleased = 0.25\n')
    done = run("monitor", ROUND, "--seconds", "3.5", "--json", "--calibration", path)
    assert 'calibration "turned"' in done.stderr
    last = json.loads(done.stdout.splitlines()[-1])
    assert last["sticks"]["left"][1] < -0.5  # the thumb has pushed the stick forward
    run("record", ROUND, "--out", out, "--seconds", "0.5", "--calibration", path)
    held = [rest for _, rest in lines(out, "K")]
    for line in ('name = "turned"', 'forward = "-y"', "released = 0.25"):
        assert line in held


def test_a_filter_of_the_calibration_is_in_the_recording(run, tmp_path, trace, out):
    path, plain = tmp_path / "filtered.toml", tmp_path / "plain.toml"
    path.write_text("[left]\nfilters_jumps = true\n")
    plain.write_text("")
    run("record", trace, "--out", out, "--calibration", path)
    assert "filters_jumps = true" in [rest for _, rest in lines(out, "K")]

    def hash_of(*options):
        return json.loads(run("replay", out, "--json", *options).stdout)["pose_hash"]

    assert hash_of() == hash_of("--calibration", path) != hash_of("--calibration", plain)


def test_monitor_warns_of_a_stick_that_moves_untouched(run, tmp_path):
    creeping = ramp(1.5, 3.0, (0.0, 0.15), (0.0, 0.21)) + [(4.5, 0.0, 0.21)]  # a drift of 0.04 a second
    untouched = write_trace(tmp_path / "untouched.hid", creeping)
    pushed = write_trace(tmp_path / "pushed.hid", ramp(1.5, 2.0, (0.0, 0.0), (0.0, 1.0)) + [(3.0, 0.0, 1.0)])
    done = run("monitor", untouched, "--seconds", "4.5", "--json")
    assert done.stderr.splitlines()[-1] == ("gaitpad monitor: gaitpad test pad (recording): a stick began to "
                                            "move untouched; this measures it: gaitpad calibrate")
    assert json.loads(done.stdout.splitlines()[-1])["untouched"] == 1
    assert "untouched" not in run("monitor", pushed, "--seconds", "3.2").stderr
