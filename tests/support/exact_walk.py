"""A small walk on level ground, exact by construction, as the three files that replay exports."""
import json
import os
import subprocess
import tempfile

import numpy as np
import pytest

from support import bvh as bvhs
from support import slices
from support.program import ROOT
from support.walk import COLUMNS, SIDES, Walk

THIGH = SHANK = 0.42
HIP_Y, HALF_WIDTH = 0.85, 0.1
HEEL, TOE, TOE_END = (0.0, -0.08, -0.05), (0.0, -0.06, 0.13), (0.0, -0.02, 0.06)
TOE_REST = 0.02


def faults_mark(*judges):
    """Marks tests that plant faults for a judge: they run in a seventh of the runs, and always for thirty commits
    after the judge changed."""
    judges = {f"tests/{name}.py" for name in judges + ("support/walk", "support/bvh", "support/exact_walk")}
    changed = subprocess.run(["git", "-C", ROOT, "diff", "--name-only", "HEAD~30"], capture_output=True, text=True, check=False)
    is_due = slices.is_chosen(min(judges), 7) or changed.returncode != 0 or judges & set(changed.stdout.split())
    return pytest.mark.skipif(not is_due, reason="a judge that did not change lately is judged in a seventh of the runs")


def smooth(t):
    t = np.clip(t, 0.0, 1.0)
    return t * t * t * (t * (6 * t - 15) + 10)


def schedule(plan, strides):
    """List of (stage, side, ticks): idle, then roll R, flight L, roll L, flight R ..., idle."""
    order = [("idle", None, 60)]
    first = plan["first"]
    for _ in range(strides):
        for side in (1 - first, first):  # the foot that has landed; the other one flies next
            order += [("roll", side, plan["roll"]), ("flight", 1 - side, plan["flight"][1 - side])]
    return order


def rotate_x(vector, angle):
    """A fixed vector turned about x by angles (rad), (N, 3)."""
    x, y, z = vector
    return np.stack([np.full_like(angle, x), y * np.cos(angle) - z * np.sin(angle),
                     y * np.sin(angle) + z * np.cos(angle)], -1)


class Maker:
    """Makes the walk: first the feet (heel place and pitch), then evenly moving hips, then the exact planar leg."""

    def __init__(self, plan, strides=18):
        self.plan, self.order = plan, schedule(plan, strides)
        self.ticks = sum(n for _, _, n in self.order)
        self.stage = np.empty(self.ticks, dtype="U6")
        self.swing = np.empty(self.ticks, dtype="U5")
        self.heel = np.zeros((2, self.ticks, 3))
        self.pitch = np.zeros((2, self.ticks))
        self.stride = np.zeros((2, self.ticks))
        self.root = np.zeros((self.ticks, 3))
        self._feet()
        self._hips()

    def _feet(self):
        plan, k = self.plan, 0
        heel_z, pitch = np.zeros(2), np.zeros(2)  # places and pitches of the feet at the end of the stage before
        for number, (stage, side, n) in enumerate(self.order):
            part, t = slice(k, k + n), (np.arange(n) + 1) / n
            self.stage[part], self.swing[part] = stage, "none" if side is None else SIDES[side]
            for foot in range(2):
                self.stride[foot, part] = plan["length"][foot]
                self._foot(foot, stage, side, part, t, heel_z, pitch, number)
            if stage == "flight":
                heel_z[side] = heel_z[1 - side] + plan["length"][side]
            pitch[:] = self.pitch[:, k + n - 1]
            k += n

    def _foot(self, foot, stage, side, part, t, heel_z, pitch, number):
        n = len(t)
        flat = np.stack([np.zeros(n), np.zeros(n), np.full(n, heel_z[foot])], -1)
        if stage == "idle" or (stage == "roll" and number < 2 and foot == side):
            self.heel[foot, part] = flat
        elif stage == "roll" and foot == side:  # the heel is planted and the toe drops
            self.pitch[foot, part] = pitch[foot] * (1 - smooth(t / 0.95))
            self.heel[foot, part] = flat
        elif stage == "flight" and foot == side:
            self._fly(foot, part, t, heel_z, pitch)
        else:  # the toe is planted and the heel rises
            low, high = (0.0, 0.20) if stage == "flight" else (pitch[foot], 0.45)
            angle = low + (high - low) * smooth((t - 0.5) * 2 if stage == "flight" else t)
            self.pitch[foot, part] = angle
            toe = np.array([0.0, TOE_REST, heel_z[foot] + TOE[2] - HEEL[2]])
            self.heel[foot, part] = toe + rotate_x(np.subtract(HEEL, TOE), angle)

    def _fly(self, foot, part, t, heel_z, pitch):
        plan = self.plan
        start = self.heel[foot, part.start - 1]
        end = np.array([0.0, 0.0, heel_z[1 - foot] + plan["length"][foot]])
        path = start + (end - start) * smooth(t)[:, None]
        path[:, 1] = start[1] * (1 - smooth(t)) + plan["height"][foot] * 16 * (t * (1 - t)) ** 2
        self.heel[foot, part] = path
        bump = plan.get("bump", 0.0) * 16 * (t * (1 - t)) ** 2
        self.pitch[foot, part] = pitch[foot] + (-0.25 - pitch[foot]) * smooth(t) + bump

    def _hips(self):
        """Moves the hips between the feet at an even speed, reached smoothly within the first half second."""
        cycle = 2 * self.plan["roll"] + sum(self.plan["flight"])
        speed = sum(self.plan["length"]) / cycle
        k = np.arange(self.ticks) - 60
        self.speed_m_s = speed * 240
        self.root[:, 1] = HIP_Y
        self.root[:, 2] = -0.05 + 0.2 * self.plan["length"][0] + speed * (60 + np.cumsum(smooth(k / 120)))

    def leg_angles(self, foot):
        """The rotations of hip, knee, ankle and toe about x in radians."""
        hip = self.root + [0, 0, 0]
        ankle = self.heel[foot] - rotate_x(HEEL, self.pitch[foot])
        reach = ankle - hip
        distance = np.hypot(reach[:, 1], reach[:, 2])
        bend = np.arccos(np.clip((THIGH ** 2 + SHANK ** 2 - distance ** 2) / (2 * THIGH * SHANK), -1, 1))
        line = np.arctan2(-reach[:, 2], -reach[:, 1])  # rotation about x that turns -y to the line
        knee = np.pi - bend
        thigh = line - knee / 2
        return thigh, knee, self.pitch[foot] - thigh - knee, -np.maximum(self.pitch[foot], 0)


JOINTS = [("Hips", -1, (0, 0, 0))]
for _side, _sign in (("Left", 1), ("Right", -1)):
    _at = len(JOINTS)
    JOINTS += [(_side + "UpLeg", 0, (_sign * HALF_WIDTH, 0, 0)), (_side + "Leg", _at, (0, -THIGH, 0)),
               (_side + "Foot", _at + 1, (0, -SHANK, 0)), (_side + "ToeBase", _at + 2, TOE),
               (_side + "ToeBase_End", _at + 3, TOE_END)]
JOINTS += [("Spine", 0, (0, 0.2, 0)), ("Spine_End", 11, (0, 0.3, 0))]


def pose_of(maker):
    bvh = bvhs.Bvh()
    bvh.names = [n for n, _, _ in JOINTS]
    bvh.parents = [p for _, p, _ in JOINTS]
    bvh.offsets = np.array([o for _, _, o in JOINTS], dtype=float) * 100
    bvh.end_site = [n.endswith("_End") for n in bvh.names]
    spin = ["Zrotation", "Xrotation", "Yrotation"]
    bvh.channels = [[] if e else spin for e in bvh.end_site]
    bvh.channels[0] = ["Xposition", "Yposition", "Zposition"] + spin
    bvh.first = list(np.cumsum([0] + [len(c) for c in bvh.channels])[:-1])
    bvh.data = np.zeros((maker.ticks, sum(len(c) for c in bvh.channels)))
    bvh.data[:, :3] = maker.root * 100
    for foot in range(2):
        for n, angle in enumerate(maker.leg_angles(foot)):
            bvh.data[:, bvh.first[1 + 5 * foot + n] + 1] = np.degrees(angle)
    cycle = 2 * maker.plan["roll"] + sum(maker.plan["flight"])
    bvh.data[:, bvh.first[11] + 2] = 5 * np.sin(2 * np.pi * np.arange(maker.ticks) / cycle)
    bvh.frame_time = 1 / 240
    return bvh


def summary_of(maker, landings):
    text = {"ticks": maker.ticks, "rate_hz": 240, "pose_hash": "0" * 16, "motion": "procedural",
            "metres_per_unit": 0.01, "leg_length_m": THIGH + SHANK, "source_leg_length_m": THIGH + SHANK,
            "ik_failures": 0, "reports": 1, "bad_reports": 0}
    for foot, side in enumerate(SIDES):
        text.update({f"{side}_toe_joint": f"{side.title()}ToeBase", f"{side}_ankle_joint": f"{side.title()}Foot",
                     f"{side}_heel_offset_m": list(HEEL), f"{side}_toe_rest_m": TOE_REST,
                     f"steps_{side}": landings[foot]})
    return text


def columns_of(maker):
    n = maker.ticks
    col = {name: np.zeros(n) for name in COLUMNS}
    col["tick"] = np.arange(n)
    col["time_s"] = np.arange(n) / 240
    col["stage"], col["swing"] = maker.stage, maker.swing
    walking = maker.stage != "idle"
    col["stick_y"] = np.where(walking, 0.8, 0.0)
    col["speed_m_s"] = np.where(walking, maker.speed_m_s, 0)
    for axis, name in enumerate("xyz"):
        col[f"root_{name}_m"] = maker.root[:, axis]
    for foot, side in enumerate(SIDES):
        landed = (maker.stage == "roll") & (maker.swing == side)
        lifted = (maker.stage != "idle") & (maker.swing == side) & (maker.stage == "flight")
        behind = (maker.stage == "roll") & (maker.swing != side)
        col[f"{side}_heel_planted"] = (maker.stage == "idle") | landed
        col[f"{side}_toe_planted"] = ~lifted & (~landed | behind)
        col[f"stride_{side}_m"] = maker.stride[foot]
        place = maker.heel[foot] + [HALF_WIDTH if foot == 0 else -HALF_WIDTH, 0, 0]
        toe = place + rotate_x(np.subtract(TOE, HEEL), maker.pitch[foot])
        for axis, name in enumerate("xyz"):
            col[f"{side}_heel_{name}_m"], col[f"{side}_toe_{name}_m"] = place[:, axis], toe[:, axis]
    return col


class Files:
    """The three exported files in memory, to be spoilt and written."""

    def __init__(self, **plan):
        base = {"first": 0, "roll": 60, "flight": (180, 180), "length": (0.32, 0.32), "height": (0.1, 0.1)}
        maker = Maker({**base, **plan})
        self.bvh, self.col = pose_of(maker), columns_of(maker)
        landings = [int(((maker.stage[:-1] == "flight") & (maker.stage[1:] == "roll") &
                         (maker.swing[1:] == s)).sum()) for s in SIDES]
        self.summary = summary_of(maker, landings)

    def load(self, changes=()):
        with tempfile.TemporaryDirectory() as folder:
            bvhs.write_bvh(self.bvh, os.path.join(folder, "pose.bvh"), 7)
            with open(os.path.join(folder, "summary.json"), "w", encoding="utf-8") as file:
                json.dump(self.summary, file)
            texts = [v if v.dtype.kind == "U" else v.astype(int).astype(str) if v.dtype.kind in "bi" else
                     np.char.mod("%.9f", v) for v in self.col.values()]
            with open(os.path.join(folder, "frames.csv"), "w", encoding="utf-8") as file:
                file.write(",".join(self.col) + "\n" + "\n".join(",".join(row) for row in zip(*texts)) + "\n")
            return Walk(folder, changes=changes)

    def channel(self, joint, name):
        j = self.bvh.index(joint)
        return self.bvh.data[:, self.bvh.first[j] + self.bvh.channels[j].index(name)]
