"""gaitpad decode: its JSON against a second report-descriptor parser, written from HID 1.11 and hid-core.c."""
import glob
import json
import os
import subprocess
import sys
import tempfile

GAITPAD = sys.argv[1]
HERE = os.path.dirname(os.path.abspath(__file__))
PADS = sorted(glob.glob(os.path.join(HERE, "../data/pads/*.hid")))
SHARED = sorted(glob.glob(os.path.join(HERE, "../../../shared/data/hid/*.hid")))


def run(*arguments):
    return subprocess.run([GAITPAD, "decode", *arguments], capture_output=True, text=True)


def signed(value, size):
    return value - (1 << 8 * size) if size and value >> (8 * size - 1) else value


class Parser:
    def __init__(self):
        self.now = {"page": 0, "min": (0, 0), "max": (0, 0), "size": 0, "count": 0, "id": 0}
        self.pushed, self.usages, self.low, self.bits, self.fields = [], [], 0, {}, []

    def add(self, kind, tag, value, size):
        if kind == 1:
            keys = {0: "page", 7: "size", 8: "id", 9: "count"}
            if tag in keys:
                self.now[keys[tag]] = value
            elif tag in (1, 2):
                self.now["min" if tag == 1 else "max"] = (value, size)
            elif tag == 10:
                self.pushed.append(dict(self.now))
            elif tag == 11:
                self.now = self.pushed.pop()
        elif kind == 2:
            page = self.now["page"]
            if tag == 0:
                usage = (value >> 16, value & 0xFFFF) if size == 4 else (page, value)
                self.usages.append((usage, size == 4))
            elif tag == 1:
                self.low = value
            elif tag == 2:
                self.usages += [((page, u), False) for u in range(self.low, value + 1)]
        elif kind == 0:
            self.reach_back()
            if tag in (8, 9, 11):
                self.add_fields({8: "input", 9: "output", 11: "feature"}[tag], value)
            self.usages = []

    def reach_back(self):
        for i in range(len(self.usages) - 1, -1, -1):
            (page, usage), extended = self.usages[i]
            if extended:
                continue
            if page == self.now["page"]:
                break
            self.usages[i] = ((self.now["page"], usage), False)

    def add_fields(self, kind, flags):
        now = self.now
        offset = self.bits.get((kind, now["id"]), 0)
        low = signed(*now["min"])
        high = signed(*now["max"]) if low < 0 else now["max"][0]
        if low > high:
            low, high = 0, (1 << now["size"]) - 1
        for i in range(now["count"]):
            usage = (now["page"], 0)
            if self.usages:
                usage = self.usages[min(i, len(self.usages) - 1) if flags & 2 else 0][0]
            if not flags & 1 and now["size"]:
                self.fields.append({"report_id": now["id"], "bit_offset": offset, "bit_size": now["size"],
                                    "usage_page": usage[0], "usage": usage[1], "logical_min": low,
                                    "logical_max": high, "kind": kind})
            offset += now["size"]
        self.bits[(kind, now["id"])] = offset


def fields_of(data):
    parser, i = Parser(), 0
    while i < len(data):
        size = (0, 1, 2, 4)[data[i] & 3]
        value = int.from_bytes(data[i + 1:i + 1 + size], "little")
        parser.add(data[i] >> 2 & 3, data[i] >> 4, value, size)
        i += 1 + size
    return parser.fields


def recording(path):
    descriptor, reports = None, []
    with open(path, errors="replace") as file:
        for line in file:
            words = line.split()
            if line.startswith("R:"):
                descriptor = bytes(int(w, 16) for w in words[2:])
            if line.startswith("E:"):
                reports.append((float(words[1]), bytes(int(w, 16) for w in words[3:])))
    return descriptor, reports


def values_of(fields, report):
    numbered = any(f["report_id"] for f in fields)
    report_id, data = (report[0], report[1:]) if numbered else (0, report)
    bits, values = int.from_bytes(data, "little"), {}
    for f in fields:
        if f["kind"] != "input" or f["report_id"] != report_id:
            continue
        value = bits >> f["bit_offset"] & ((1 << f["bit_size"]) - 1)
        if f["logical_min"] < 0 and value >> (f["bit_size"] - 1):
            value -= 1 << f["bit_size"]
        values.setdefault("%04x:%04x" % (f["usage_page"], f["usage"]), value)
    return report_id, values


def check_file(path, has_arrays):
    descriptor, reports = recording(path)
    done = run(path, "--json")
    assert done.returncode == 0, done.stderr
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    assert list(lines[0]) == ["device", "pad", "fields"], path
    fields = fields_of(descriptor)
    assert lines[0]["fields"] == fields, path
    assert len(lines) == 1 + len(reports), path
    if has_arrays:
        return
    for line, (time_s, report) in zip(lines[1:], reports):
        report_id, values = values_of(fields, report)
        assert line["report_id"] == report_id and line["values"] == values, (path, time_s)
        assert line["device"] == 0 and abs(line["time_s"] - time_s) < 1e-9


def check_failures(folder):
    path = os.path.join(folder, "damaged.hid")
    with open(path, "w") as file:
        file.write("R: 2 05 01\nE: 000000.000000 2 00\nE: 000000.000001 1 00\n")
    damaged = run(path, "--json")
    assert damaged.returncode == 1 and damaged.stdout == "" and ":2: " in damaged.stderr
    lenient = run(path, "--json", "--lenient")
    assert lenient.returncode == 0 and len(lenient.stdout.splitlines()) == 2, lenient
    assert run(os.path.join(folder, "none.hid")).returncode == 1
    assert run("/dev/hidraw99").returncode == 1
    assert "no driver sees" in run("/dev/hidraw99").stderr
    assert run().returncode == 2
    assert run(path, "--nonsense").returncode == 2


for pad in PADS:
    check_file(pad, False)
for pad in SHARED:
    check_file(pad, any(name in pad for name in ("legion_go_shortcuts", "rog_ally", "elite2")))
with tempfile.TemporaryDirectory() as temporary:
    check_failures(temporary)
print(len(PADS), "pads,", len(SHARED), "shared recordings")
