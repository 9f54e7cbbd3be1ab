"""gaitpad decode: its JSON against a second report-descriptor parser, written from HID 1.11 and hid-core.c."""
import json
import re

import pytest

from support import traces
from support.program import DATA, ROOT, ROUND

PADS = sorted((ROOT / "tests/data/pads").glob("*.hid"))
SHARED = sorted((DATA / "hid").glob("*.hid"))
ARRAYS = ("legion_go_shortcuts", "rog_ally", "elite2")  # only their fields are compared


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


@pytest.mark.parametrize("path", PADS + (SHARED or [None]), ids=lambda path: path.stem if path else "recordings")
def test_fields_and_values_are_those_of_a_second_parser(run, path):
    if path is None:
        pytest.skip(f"there are no recordings at {DATA / 'hid'}")
    descriptor = bytes.fromhex("".join(traces.lines(path, "R")[-1][1].split()[1:]))
    reports = traces.reports(path)
    told, *rows = [json.loads(line) for line in run("decode", path, "--json").stdout.splitlines()]
    assert list(told) == ["device", "pad", "fields"]
    fields = fields_of(descriptor)
    assert told["fields"] == fields
    assert len(rows) == len(reports)
    if path in SHARED and any(name in path.name for name in ARRAYS):
        return
    for row, (time_s, report) in zip(rows, reports):
        report_id, values = values_of(fields, report)
        assert row["report_id"] == report_id and row["values"] == values, time_s
        assert row["device"] == 0 and abs(row["time_s"] - time_s) < 1e-9


def test_a_damaged_line_is_named_and_can_be_skipped(run, tmp_path):
    path = tmp_path / "damaged.hid"
    path.write_text("R: 2 05 01\nE: 000000.000000 2 00\nE: 000000.000001 1 00\n")
    damaged = run("decode", path, "--json", status=1)
    assert damaged.stdout == "" and ":2: " in damaged.stderr
    assert len(run("decode", path, "--json", "--lenient").stdout.splitlines()) == 2
    run("decode", path, "--nonsense", status=2)


def test_what_is_not_there_cannot_be_decoded(run, tmp_path):
    run("decode", tmp_path / "none.hid", status=1)
    assert "no driver sees" in run("decode", "/dev/hidraw99", status=1).stderr
    run("decode", status=2)


def test_usages_have_their_names(run):
    rows = run("decode", ROUND, "--descriptor").stdout
    for name in ("X", "Rz", "Hat switch", "Button 12"):
        assert re.search(rf"[0-9a-f]{{4}}:[0-9a-f]{{4}} +{name} ", rows), rows
