"""From the gadget's write to `gaitpad play`, by every driver: to its own thread, and to the begin of the tick that
uses the report.

Reports of the generic pad, 250 a second, each numbered in its left stick. A driver's blocks alternate
with those of a bare poll() and read() of the node, since the same read differs by a tenth from one run to
the next. Work beside the emulator makes some reports of a block late, never one early: what is judged is each
block's first quartile. Writes latency.md and latency.csv to the results.
"""
import csv
import pathlib
import statistics
import subprocess
import time

import pytest

from pads import LONG, Pad
from session import BUILD, HAS_SANITIZERS, Session, remark

RESULTS = pathlib.Path("/results")
GENERIC = "1209:0001"
RATE_HZ, SECONDS = 250, 0.8
BLOCKS = 10 if LONG else 3
ATTEMPTS = 3
LOST_BY_SDL = 0.02  # share that SDL may miss: it keeps only the newest state, and a busy host delays the guest
WARM_UP = 10  # reports of a block that are not counted: the first is written before any reader polls
# driver: (the bare read beside it, by how much its first quartile may exceed that one's, in us). A reader that looks
# once in a millisecond would exceed it by 250, one of SDL's looks in two by 500.
LIMITS_US = {"hidraw": ("bare_hidraw", 150), "usb": ("bare_hidraw", 150), "evdev": ("bare_evdev", 150),
             "sdl": ("bare_evdev", 1000)}
LABELS = {"bare_hidraw": "bare `poll` + `read` of the hidraw node", "bare_evdev": "the same of the event node",
          "plain_sdl": "a plain SDL2 program (`SDL_WaitEventTimeout`)"}


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def latencies_us(sent, received):
    """Times from writing to arrival, by number. The first of equal numbers counts."""
    arrival = {}
    for ns, number in received:
        arrival.setdefault(number, ns)
    return [(arrival[number] - ns) / 1000 for ns, number in sent if number in arrival]


def written(pad, before):
    """The numbers written after the first `before` reports, as (ns, number in the left stick), without the warm-up."""
    return [(s.ns, s.data[0] + 256 * s.data[1]) for s in pad.sent()[before:]][WARM_UP:]


def bare_block(pad, way, ids=GENERIC):
    """The arrivals of one block at a reader that does nothing else, as (ns, number). `ids`: ids of the node."""
    program = [f"{BUILD}/tools/rig/rig_plain_sdl"] if way == "plain_sdl" else [f"{BUILD}/tools/rig/rig_latency", way]
    with subprocess.Popen([*program, ids, "1000"], stdout=subprocess.PIPE, text=True) as reader:
        if reader.stdout.readline() != "ready\n":
            raise RuntimeError(f"{way} did not open the pad")
        pad.burst(RATE_HZ, SECONDS, at=0)
        received = [tuple(map(int, line.split())) for line in reader.stdout]
    if reader.returncode != 0:
        raise RuntimeError(f"{way} failed")
    return received, []


def play_block(pad, driver):
    """The arrivals of one block in `play`, on its own threads, and the begins of ticks as (ns, number)."""
    times = RESULTS / f"latency_{driver}.csv"
    with Session(GENERIC, "--driver", driver, "--no-rumble", "--report-times", times, name=f"latency_{driver}") as session:
        time.sleep(0.5)
        pad.set(lx=127, ly=129)  # SDL ignores small first movements
        pad.set(lx=128, ly=128)
        time.sleep(0.2)
        pad.burst(RATE_HZ, SECONDS, at=0)
        pad.wait_burst()
        time.sleep(0.3)
    numbers = [round((row["axes"]["left_x"] + 1) * 127.5) + 256 * round((1 - row["axes"]["left_y"]) * 127.5)
               for row in session.decoded()]
    with open(times, newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(numbers), f"{len(rows)} times of {len(numbers)} reports"
    return [[(int(row[key]), number) for row, number in zip(rows, numbers)] for key in ("arrival_ns", "begin_ns")]


def block(pad, way):
    """The latencies of one block in us: until arrival, until the tick's begin; and the number of lost reports."""
    before = len(pad.sent())
    received, begins = play_block(pad, way) if way in LIMITS_US else bare_block(pad, way)
    pad.wait_burst()
    sent = written(pad, before)
    found = latencies_us(sent, received)
    return found, latencies_us(sent, begins), len(sent) - len(found)


def over_bare_us(blocks, driver, what):
    """The median of the differences between each block and its bare neighbour; one noisy block does not move it."""
    return statistics.median(a[what] - b[what] for a, b in zip(blocks[driver], blocks[LIMITS_US[driver][0]]))


FIRST_QUARTILE, MEDIAN = 0, 1


def quartiles(values):
    ordered = sorted(values)
    return [percentile(ordered, share) for share in (0.25, 0.5, 0.75, 0.99)]


def write(found, blocks, ticks):
    """Writes the tables to one decimal, the median with the quartiles: blocks of one read differ by more than that."""
    rows = [["way", "reports", "q1_us", "median_us", "q3_us", "p99_us", "over_bare_us", "to_tick_q1_us", "to_tick_median_us",
             "to_tick_q3_us", "to_tick_p99_us"]]
    text = ["| way | to the program | 99th percentile | over the bare read | to the tick's begin | 99th percentile |",
            "|---|---|---|---|---|---|"]
    for way, values in found.items():
        over = over_bare_us(blocks, way, MEDIAN) if way in LIMITS_US else None
        there, tick = quartiles(values), quartiles(ticks[way]) if ticks.get(way) else 4 * [None]
        rows.append([way, len(values), *there, over, *tick])
        cells = [spread_text(there), ms_text(there[3]), ms_text(over), spread_text(tick), ms_text(tick[3])]
        text.append(f"| {LABELS.get(way, f'`{way}` driver')} | " + " | ".join(cells) + " |")
    with open(RESULTS / "latency.csv", "w", newline="") as file:
        csv.writer(file).writerows(rows)
    (RESULTS / "latency.md").write_text("\n".join(text) + "\n")
    for line in text:
        remark(line)


def ms_text(us):
    return "-" if us is None else f"{us / 1000:.1f} ms"


def spread_text(quarters):
    return "-" if quarters[1] is None else f"{ms_text(quarters[1])} ({quarters[0] / 1000:.1f} to {quarters[2] / 1000:.1f})"


def measure(pad, ways, found, ticks, lost):
    """Measures BLOCKS blocks of each way, in turns; returns the quartiles of each block."""
    blocks = {way: [] for way in ways}
    for _ in range(BLOCKS):
        for way in ways:
            values, to_ticks, missing = block(pad, way)
            print(f"{way}: {len(values)}, {missing} lost, quartiles and 99th percentile in us {quartiles(values)}", flush=True)
            found[way] += values
            ticks[way] += to_ticks
            blocks[way].append(quartiles(values))
            lost[way] += missing
            pad.wait_ready()
    return blocks


def too_slow(blocks):
    return [way for way in blocks if way in LIMITS_US and over_bare_us(blocks, way, FIRST_QUARTILE) > LIMITS_US[way][1]]


@pytest.mark.timeout(600)
def test_drivers_are_as_fast_as_the_bare_read():
    if HAS_SANITIZERS:
        pytest.skip("a program with sanitizers is slower by design")
    ways = ["bare_hidraw", "hidraw", "bare_evdev", "evdev", "sdl", "plain_sdl", "usb"]
    found = {way: [] for way in ways}
    ticks = {way: [] for way in ways}
    lost = dict.fromkeys(ways, 0)
    with Pad("generic") as pad:
        blocks = measure(pad, ways, found, ticks, lost)
        slow = too_slow(blocks)
        # The host may be busy for a while: ways that were too slow are measured again with their bare reads.
        for _ in range(ATTEMPTS):
            if slow:
                slow = too_slow(measure(pad, [*{LIMITS_US[way][0]: None for way in slow}, *slow], found, ticks, lost))
    write(found, blocks, ticks)
    for driver, (_, limit_us) in LIMITS_US.items():
        most_lost = LOST_BY_SDL * len(found[driver]) if driver == "sdl" else 0
        assert lost[driver] <= most_lost, f"{driver} lost {lost[driver]}"
        assert len(ticks[driver]) > 300, f"{driver}: {len(ticks[driver])} reports found in ticks"
        assert driver not in slow, f"{driver} takes over {limit_us} us more than the bare read, {1 + ATTEMPTS} times in a row"
