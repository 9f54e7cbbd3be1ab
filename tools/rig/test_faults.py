"""Faults of pads: unplugging, silence, stalls, floods, odd packets, missing permission.

Each fault 50 times with --long, two to five times otherwise. A session must survive, be neutral in time, leak no handle,
and replay to the same poses (session.py asserts that at the end of each).
"""
import contextlib
import glob
import json
import os
import random
import select
import signal
import statistics
import subprocess
import threading
import time

import pytest

import pads
from pads import LONG, Pad, settle, wait_for
from session import HAS_SANITIZERS, IDS, PROGRAM, TICK_S, Session, record, remark, run, tick_times_ns, ticks_of
from test_matrix import NAMES, VALUES, expected_stick

# A session with sanitizers takes most of the guest's one core.
TIMES = 50 if LONG else 2 if HAS_SANITIZERS else 5
OPENINGS = 50 if LONG else 2  # number of openings for tests in which they do not differ
NOBODY = 65534
NEUTRAL_S = 1.0 if HAS_SANITIZERS else 0.15  # limit of the median until the stick is neutral, on USB
OVER_BARE_S = 0.05  # allowed after a bare poll() that sees the same, for a slow host
RULES = "/etc/udev/rules.d/60-gaitpad.rules"


def push_forward(pad):
    pad.set(ly=VALUES[pad.kind]["rest"])
    time.sleep(0.1)
    pad.move(ly=(VALUES[pad.kind]["rest"], VALUES[pad.kind]["forward"]))


def neutral_in_time(frames, ticks, seconds=0.1):
    """Checks that after each of these ticks the stick is neutral within that number of seconds."""
    for tick in ticks:
        after = frames[min(len(frames) - 1, tick + round(seconds / TICK_S) + 1)]
        assert float(after["stick_x"]) == float(after["stick_y"]) == 0.0, (tick, after["stick_y"])


class BareWatch:
    """Measures when the pad is unplugged, in parallel, by poll() on its usbfs node; ns of CLOCK_MONOTONIC."""

    def __init__(self, pad):
        self._fd = os.open(pad.usb, os.O_RDWR | os.O_CLOEXEC)
        self._thread = threading.Thread(target=self._wait, daemon=True)
        self._thread.start()

    def _wait(self):
        gone = select.poll()
        gone.register(self._fd, select.POLLHUP)
        gone.poll(60_000)
        self._ns = time.monotonic_ns()

    def noticed_ns(self):
        self._thread.join()
        os.close(self._fd)
        return self._ns


@pytest.mark.timeout(900)
@pytest.mark.parametrize("case", ["generic-hidraw", "generic-usb", "xbox360-evdev",
                                  pytest.param("dualsense-hidraw", marks=pytest.mark.long),
                                  pytest.param("generic-sdl", marks=pytest.mark.long)])
def test_unplugged_while_walking_and_plugged_in_again(case):
    kind, driver = case.split("-")
    times = TIMES if case in ("generic-hidraw", "generic-usb", "xbox360-evdev") or not LONG else 10
    bare_ns = []
    with Pad(kind) as pad, Session(IDS[kind], "--driver", driver, name=f"unplug-{case}") as session:
        for turn in range(times):
            push_forward(pad)
            time.sleep(0.8)
            bare = BareWatch(pad)
            pad.unplug()
            session.wait_unplugged(turn + 1)
            bare_ns.append(bare.noticed_ns())
            if turn == 0:
                handles = session.handles()
            pad.plug()
            session.wait_plugged(turn + 2)
        pad.unplug()
        session.wait_unplugged(times + 1)
        time.sleep(2.0 * (pads.PATIENCE if HAS_SANITIZERS else 1))  # the walk finishes its step and stands
        # Looking for the pad opens a file now and then; what leaks stays open.
        wait_for(lambda: session.handles() <= handles, 10, f"{handles} handles as at first, not {session.handles()}")
        unplugged_ns = [int(line[1]) for line in pad.lines("unplugging")]
    assert session.summary["unplugged"] == times + 1
    frames = session.frames()
    removals = ticks_of(session.lines(), lambda line: line.startswith("H:") and "remove" in line)
    neutral_in_time(frames, removals, 0.0)  # at the tick that learns of it
    time_ns = tick_times_ns(session.lines())
    took_s = sorted((time_ns(tick) - ns) / 1e9 for tick, ns in zip(removals, unplugged_ns))
    # By the ticks' due times: a loop that is late on a busy machine takes a removal in a tick that was due before it.
    assert len(took_s) == times + 1, took_s
    bare_s = statistics.median((bare - ns) / 1e9 for bare, ns in zip(bare_ns, unplugged_ns))
    # From the moment the pad lets go of the bus: most of it is the kernel's hub driver.
    assert statistics.median(took_s) < max(NEUTRAL_S, bare_s + OVER_BARE_S), (took_s, bare_s)
    assert sum(frame["stage"] != "idle" for frame in frames) > 100 * times
    assert frames[-1]["stage"] == "idle"
    remark(f"unplugged while walking, {case}: {times} times, neutral {statistics.median(took_s):.3f} s after the pad left the "
           f"bus (median; a bare poll() {bare_s:.3f} s), {took_s[min(len(took_s) - 1, int(0.99 * len(took_s)))]:.3f} s (99th percentile)")


@pytest.mark.timeout(900)
def test_unplugged_during_open():
    """Random plugging during a session and a loop of programs that open every pad."""
    chance = random.Random(1)
    with Pad("dualsense") as pad, Session(IDS["dualsense"], name="flapping") as session:
        for _ in range(TIMES):
            pad.command("unplug")
            time.sleep(chance.uniform(0.02, 0.4))
            pad.command("plug")
            opener = subprocess.Popen([PROGRAM, "record", IDS["dualsense"], "--out", "/tmp/opened.hid", "--seconds", "0.5"],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            time.sleep(chance.uniform(0.02, 0.9))
            pad.command("unplug")
            time.sleep(chance.uniform(0.02, 0.2))
            pad.command("plug")
            _, errors = opener.communicate(timeout=60 * pads.PATIENCE)
            assert opener.returncode in (0, 1) and "Sanitizer" not in errors, (opener.returncode, errors)
        pad.wait_ready(60)
        reports = len(session.lines("E:"))
        wait_for(lambda: session.plugged() > session.unplugged() and len(session.lines("E:")) > reports, 30, "the pad back")
        pad.set(ly=0)
    remark(f"unplugged during open: {TIMES} times, {session.summary['unplugged']} openings were cut")


@pytest.mark.timeout(120)
def test_a_pad_is_not_taken_from_the_kernel_unasked():
    with Pad("xbox360") as pad:
        node = pad.joystick
        done = subprocess.run([PROGRAM, "decode", pad.usb, "--seconds", "1"], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=60, check=False)
        assert done.returncode == 1 and "the kernel's driver xpad has the pad" in done.stderr, done
        assert node and pad.joystick == node, "xpad was detached"


@pytest.mark.timeout(120)
def test_looking_at_pads_grabs_no_node(tmp_path):
    """Another program that reads the node must not miss what comes meanwhile."""
    calls = tmp_path / "calls"
    with Pad("xbox360") as pad:
        for command in (["doctor"], ["pads"]):
            subprocess.run(["strace", "-f", "-e", "trace=openat,ioctl", "-o", calls, PROGRAM, *command], stdin=subprocess.DEVNULL,
                           stdout=subprocess.DEVNULL, timeout=60, check=False)
            text = calls.read_text()
            assert pad.events[0] in text, "it did not look at the node"
            assert "EVIOCGRAB" not in text, command


@pytest.mark.timeout(200)
def test_two_equal_pads_are_kept_apart():
    with Pad("dualsense", 0) as first, Pad("dualsense", 1) as second:
        rows = [row for row in json.loads(run("gaitpad", "pads", "--driver", "hidraw", "--json").stdout) if row["usable"]]
        unique = {row["port"]: row["unique_id"] for row in rows}
        assert len(unique) == 2 and len(set(unique.values())) == 2, rows
        ids = {pad: next(name for port, name in unique.items() if f"dummy_hcd.{pad.index}" in port)
               for pad in (first, second)}
        for turn in range(OPENINGS):
            mine, other = (first, second) if turn % 2 else (second, first)
            mine.set(lx=40 + turn)
            other.set(lx=200)
            values = {line.split()[4] for line in record(ids[mine], reports=100) if line.startswith("E:")}
            assert values == {f"{40 + turn:02x}"}, (turn, values)
    with Pad("dualsense", 0) as first, Pad("dualsense", 1) as second, \
            Session("--driver", "hidraw", name="equal", awaited=2) as session:
        for turn in range(3):
            first.unplug()
            session.wait_unplugged(2 * turn + 1)
            second.unplug()
            session.wait_unplugged(2 * turn + 2)
            second.plug()  # plugged in the other order, the pads still send their own numbers
            session.wait_plugged(3 + 2 * turn)
            first.plug()
            session.wait_plugged(4 + 2 * turn)
    assert sum(line.startswith("R:") for line in session.lines()) == 2, "a known pad got a new number"


def numbers_of(session, at):
    """The numbers in the reports, by the device's unique id."""
    found, unique, device = {}, {}, "0"
    for line in session.lines():
        if line.startswith("D:"):
            device = line[3:]
        elif line.startswith("U:"):
            unique[device] = line[3:]
        elif line.startswith("E:"):
            data = bytes.fromhex("".join(line.split()[3:]))
            found.setdefault(unique.get(device, device), []).append(int.from_bytes(data[at:at + 4], "little"))
    return found


@pytest.mark.timeout(400)
@pytest.mark.parametrize("driver", ["hidraw", "usb"])
def test_flood_of_four_pads_with_a_paused_reader(driver):
    """Each report carries its number, so every gap is seen, and the newest report is right."""
    # Slow enough for a busy host: a stopped program leaves its time to the pads, which must not send faster by it.
    rate_hz, seconds = (1000, 60) if LONG and not HAS_SANITIZERS else (125, 8)
    at = 8  # place of the vendor bytes of the generic pad
    with four_pads() as pads_, Session("1209:0001", "--driver", driver, "--no-rumble", name=f"flood-{driver}",
                                               awaited=1) as session:
        wait_for(lambda: session.plugged() >= 4, 60, "four pads")
        for pad in pads_:
            pad.burst(rate_hz, seconds, at=at)
        for _ in range(3):
            time.sleep(seconds / 6)
            session.process.send_signal(signal.SIGSTOP)
            time.sleep(0.9)
            session.process.send_signal(signal.SIGCONT)
        sent = [pad.wait_burst(3 * seconds + 60)[0] for pad in pads_]
        session.wait_quiet()
    found = numbers_of(session, at)
    assert len(found) == 4, found.keys()
    gaps = stretches = 0
    for (name, numbers), count in zip(sorted(found.items()), sent):
        numbers = numbers[numbers.index(0):] if 0 in numbers else numbers
        assert all(b > a for a, b in zip(numbers, numbers[1:]) if b != 0), f"{name}: out of order"
        assert numbers[-1] == count - 1, f"{name}: the last report is {numbers[-1]} of {count}"
        gaps += count - len(set(numbers) & set(range(count)))
        stretches += sum(b > a + 1 for a, b in zip(numbers, numbers[1:]))
    assert session.summary["lost"] >= stretches, f"{session.summary['lost']} losses counted, there are {stretches} gaps"
    remark(f"flood, {driver}: 4 x {rate_hz} Hz x {seconds} s, {sum(sent)} sent, {gaps} lost while the reader was stopped "
           f"three times in {stretches} gaps, {session.summary['lost']} losses counted")


@pytest.mark.timeout(120)
@pytest.mark.parametrize("driver", ["hidraw", "usb", "evdev"])
def test_the_last_state_is_right_after_a_burst_with_a_stopped_reader(driver):
    """The pad reports each change once. The program is stopped for longer than the kernel keeps reports: hidraw drops
    the newest ones, and the next one is the state."""
    rate_hz, seconds = 250, 1.5
    with Pad("generic") as pad, Session(IDS["generic"], "--driver", driver, "--no-rumble", name=f"last-{driver}") as session:
        for turn in range(TIMES if LONG else 2):
            time.sleep(0.3)
            ends = len(pad.lines("burst_end"))
            pad.burst(rate_hz, seconds, at=0)  # the sticks show the report's number
            time.sleep(0.5)
            session.process.send_signal(signal.SIGSTOP)
            time.sleep(seconds)
            session.process.send_signal(signal.SIGCONT)
            wait_for(lambda: len(pad.lines("burst_end")) > ends, 20, "the burst's end")
            if driver == "hidraw":
                pad.set(ry=turn + 1)
            session.wait_quiet()
            state = dict(zip(("lx", "ly", "rx", "ry"), pad.sent()[-1].data))
            wanted = {NAMES[name]: expected_stick("generic", driver, name, value) for name, value in state.items()}
            row = decoded_last(session)
            assert all(abs(row[name] - value) < 0.002 for name, value in wanted.items()), (turn, state, row, wanted)
        pad.set(ly=128, lx=128)
    if driver == "hidraw":
        assert session.summary["lost"] >= turn + 1, session.summary
    remark(f"last state, {driver}: right after {turn + 1} bursts that ended while the reader was stopped, "
           f"{session.summary['lost']} known to be lost")


def decoded_last(session):
    """The axes of the newest report in the recording so far."""
    lines = session.lines()
    newest = max(i for i, line in enumerate(lines) if line.startswith("E:"))
    with open("/results/newest.hid", "w") as file:
        file.writelines(line + "\n" for i, line in enumerate(lines) if i == newest or not line.startswith("E:"))
    rows = map(json.loads, run("gaitpad", "decode", "/results/newest.hid", "--json").stdout.splitlines())
    return [row["axes"] for row in rows if "axes" in row][-1]


@contextlib.contextmanager
def four_pads():
    with contextlib.ExitStack() as stack:
        yield [stack.enter_context(Pad("generic", index)) for index in range(4)]


@pytest.mark.timeout(200)
@pytest.mark.parametrize("driver", ["hidraw", "usb"])
def test_a_pad_that_falls_silent_is_neutral(driver):
    with Pad("dualsense") as pad, Session(IDS["dualsense"], "--driver", driver, name=f"silent-{driver}") as session:
        for _ in range(TIMES):
            push_forward(pad)
            time.sleep(0.3)
            pad.silence()
            time.sleep(0.3)
            pad.silence(False)
            time.sleep(0.1)
    frames = session.frames()
    sticks = [float(frame["stick_y"]) for frame in frames]
    falls = [k for k in range(1, len(sticks)) if sticks[k] == 0.0 and sticks[k - 1] > 0.9]
    times_s = [float(line.split()[1]) for line in session.lines("E:")]
    silences = sum(b - a > 0.2 for a, b in zip(times_s, times_s[1:]))
    assert silences >= TIMES, f"{silences} silences recorded"
    assert len(falls) >= TIMES, f"{len(falls)} falls to neutral"
    remark(f"silent pad, {driver}: {silences} silences, neutral each time")


@pytest.mark.timeout(200)
@pytest.mark.parametrize("driver", ["usb", "hidraw"])
def test_a_stalled_endpoint_recovers(driver):
    with Pad("dualsense") as pad, Session(IDS["dualsense"], "--driver", driver, name=f"stall-{driver}") as session:
        for turn in range(TIMES):
            before = len(pad.lines("stalled"))
            pad.stall()
            wait_for(lambda: len(pad.lines("stalled")) > before, 5, "the stall")
            pad.set(lx=turn + 1)
            wait_for(lambda: any(line.split()[4] == f"{turn + 1:02x}" for line in session.lines("E:")[-400:]), 10,
                     f"reports after stall {turn}")
    assert session.unplugged() == 0
    remark(f"stalled endpoint, {driver}: {TIMES} times, goes on; {session.summary['lost']} counted as lost")


@pytest.mark.timeout(200)
def test_odd_packets_on_usb_change_nothing():
    """Packets that are short, longer than the descriptor says, or of an unknown id."""
    with Pad("dualsense") as pad, Session(IDS["dualsense"], "--driver", "usb", name="odd") as session:
        pad.stream(0)
        pad.set(lx=200)
        time.sleep(0.3)
        odd = [b"\x01\x00\x00", b"\x01", b"\x77" + bytes(63), b"\x31" + bytes(10)]
        for turn in range(TIMES):
            pad.raw(odd[turn % len(odd)])
            time.sleep(0.02)
        pad.set(lx=128)
        session.wait_quiet()
    assert session.replayed["bad_reports"] == TIMES, session.replayed
    assert not [frame for frame in session.frames() if float(frame["stick_x"]) < 0], "an odd packet moved the stick"
    remark(f"odd packets on usb: {TIMES}, each counted, none moved the stick")


@pytest.mark.timeout(400)
def test_no_permission_and_the_rule():
    group = subprocess.run(["getent", "group", "input"], capture_output=True, text=True, check=True).stdout.split(":")[2]
    as_user = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}"]

    def listed(*groups):
        done = subprocess.run([*as_user, *groups, PROGRAM, "pads", "--json"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return [row for row in json.loads(done.stdout) if row.get("product") == 0x0ce6 and row["driver"] in ("hidraw", "evdev", "usb")]

    with Pad("dualsense") as pad:
        for _ in range(OPENINGS):
            rows = [row for row in listed("--clear-groups") if row["path"] in (pad.hidraw, pad.joystick, pad.usb)]
            assert len(rows) >= 2 and not any(row["usable"] for row in rows), rows
            assert all("permission denied" in row["problem"] for row in rows), rows
        done = subprocess.run([*as_user, "--clear-groups", PROGRAM, "doctor"], capture_output=True, text=True)
        assert done.returncode == 1 and pad.hidraw in done.stdout and "--install-rules" in done.stdout, done
        done = subprocess.run([PROGRAM, "doctor", "--install-rules"], input="n\n", capture_output=True, text=True)
        assert not os.path.exists(RULES), "installed without consent"
        run("gaitpad", "doctor", "--install-rules", "--yes")
        settle()
        assert "uaccess" in pads.udev_properties(pad.hidraw).get("TAGS", "") or tagged(pad.hidraw)
        for _ in range(OPENINGS):
            rows = [row for row in listed("--groups", group) if row["path"] in (pad.hidraw, pad.joystick)]
            assert len(rows) == 2 and all(row["usable"] for row in rows), rows
        record(user=[*as_user, "--groups", group])
        pad.unplug()
        pad.plug()  # the rule applies to the next node as well
        assert [row["usable"] for row in listed("--groups", group) if row["path"] == pad.hidraw] == [True]
    remark(f"no permission: {OPENINGS} times said, after the rule {OPENINGS} times opened by an ordinary user of group input")


def tagged(node):
    return "uaccess" in subprocess.run(["udevadm", "info", "-q", "all", "-n", node], capture_output=True, text=True).stdout


@pytest.mark.timeout(120)
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGKILL", "SIGSEGV"])
def test_the_kernel_gets_its_pad_back(name):
    """The pad returns to its kernel driver, however the program ends."""
    with Pad("generic") as pad:
        for _ in range(TIMES if LONG and name == "SIGKILL" else 2):
            play = subprocess.Popen([PROGRAM, "play", IDS["generic"], "--driver", "usb", "--no-window"],
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            wait_for(lambda: not pad.hidraws and not pad.events, 20, "the pad's being taken")
            play.send_signal(getattr(signal, name))
            play.wait(20 * pads.PATIENCE)
            wait_for(lambda: pad.hidraws and pad.events, 20, "the pad's coming back")


def kill_all():
    """Sends SIGKILL to the program and to its watcher, which has the same name."""
    for folder in glob.glob("/proc/[0-9]*"):
        with contextlib.suppress(OSError), open(folder + "/comm") as file:
            if file.read().strip() == "gaitpad":
                os.kill(int(folder.rsplit("/", 1)[1]), signal.SIGKILL)


@pytest.mark.timeout(120)
@pytest.mark.parametrize("kind", ["ds4", pytest.param("generic", marks=pytest.mark.long)])
def test_after_killall_doctor_says_so_and_the_next_session_mends_it(kind):
    """No process is left to return the pad to its kernel driver, and it can be identified only by its ids or its
    name."""
    with Pad(kind) as pad:
        with subprocess.Popen([PROGRAM, "play", IDS[kind], "--driver", "usb", "--no-window"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL):
            wait_for(lambda: not pad.hidraws and not pad.events, 20, "the pad's being taken")
            time.sleep(0.5)
            kill_all()
        time.sleep(1.0)
        assert not pad.hidraws and not pad.events
        told = subprocess.run([PROGRAM, "doctor"], capture_output=True, text=True, check=False).stdout
        assert "no kernel driver is bound until it is plugged in again" in told and "drivers_probe" in told, told
        with Session(IDS[kind], "--driver", "usb", name=f"after-killall-{kind}"):
            pass
        wait_for(lambda: pad.hidraws and pad.events, 20, "the pad's coming back")


@pytest.mark.long
@pytest.mark.timeout(400)
def test_four_pads_at_a_kilohertz_undisturbed():
    with four_pads() as pads_, Session("1209:0001", "--driver", "hidraw", "--no-rumble", name="kilohertz") as session:
        wait_for(lambda: session.plugged() >= 4, 60, "four pads")
        for pad in pads_:
            pad.burst(1000, 60, at=8)
        sent = [pad.wait_burst(240)[0] for pad in pads_]
        session.wait_quiet()
    found = numbers_of(session, 8)
    missing = [count - len(set(numbers) & set(range(count))) for (_, numbers), count in zip(sorted(found.items()), sent)]
    assert sum(missing) == 0, missing
    remark(f"four pads at 1 kHz for 60 s: {sum(sent)} reports, none lost")
