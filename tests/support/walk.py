"""Loads what `gaitpad replay --out DIR` wrote and cuts it into landings, cycles and steady parts."""
import functools
import json
import os

import numpy as np

from support import bvh as bvhs

SIDES = ("left", "right")
COLUMNS = (
    "tick,time_s,stick_x,stick_y,stride_left_m,stride_right_m,speed_m_s,turn_rate_rad_s,heading_rad,"
    "root_x_m,root_y_m,root_z_m,stage,swing,left_heel_planted,left_toe_planted,right_heel_planted,"
    "right_toe_planted,left_heel_x_m,left_heel_y_m,left_heel_z_m,left_toe_x_m,left_toe_y_m,left_toe_z_m,"
    "right_heel_x_m,right_heel_y_m,right_heel_z_m,right_toe_x_m,right_toe_y_m,right_toe_z_m,"
    "left_ik_iterations,right_ik_iterations,left_ik_error_m,right_ik_error_m").split(",")
SETTLE_S = 3.0  # time after a change of stick or style from which the walk counts as steady


STAGES, SWINGS = np.array(["idle", "flight", "roll"]), np.array(["none", "left", "right"])
CODES = {f",{stage},{swing},": f",{a},{b}," for a, stage in enumerate(STAGES) for b, swing in enumerate(SWINGS)}


def read_frames(path):
    """Header and columns of frames.csv; stage, swing as text, planted as bool, the rest float."""
    with open(path, encoding="utf-8") as file:
        header, body = file.readline().strip().split(","), file.read()
    for words, numbers in CODES.items():
        body = body.replace(words, numbers)
    values = np.fromstring(body.replace("\n", ","), sep=",").reshape(body.count("\n"), len(header))
    columns = dict(zip(header, np.ascontiguousarray(values.T)))
    columns["stage"], columns["swing"] = STAGES[columns["stage"].astype(int)], SWINGS[columns["swing"].astype(int)]
    for name in header:
        if name.endswith("_planted"):
            columns[name] = columns[name] == 1
    return header, columns


class Walk:
    """One character's exported walk. Positions in metres, world; index of axis 0 is the tick."""

    def __init__(self, folder, index=1, changes=(), settle_s=SETTLE_S):
        suffix = "" if index == 1 else f"-{index}"
        self.folder = str(folder)
        name = lambda stem, ext: os.path.join(self.folder, f"{stem}{suffix}.{ext}")
        with open(name("summary", "json"), encoding="utf-8") as file:
            self.summary = json.load(file)
        self.header, self.col = read_frames(name("frames", "csv"))
        self.bvh = bvhs.read_bvh(name("pose", "bvh"))
        self.ticks = len(self.col["tick"])
        self.rate = float(self.summary["rate_hz"])
        scale = float(self.summary["metres_per_unit"])
        self.local = bvhs.local_rotations(self.bvh)
        self.position, self.rotation = bvhs.forward_kinematics(
            self.bvh.parents, bvhs.translations(self.bvh) * scale, self.local)
        self.leg_length = float(self.summary["leg_length_m"])
        self._find_legs()
        self._find_points()
        self.change_ticks = sorted(set(self._stick_changes()) | {int(round(t * self.rate)) for t in changes})
        self._find_landings()
        self._find_steady(settle_s)

    def _find_legs(self):
        b = self.bvh
        ankles = [b.index(self.summary[f"{s}_ankle_joint"]) for s in SIDES]
        chains = [b.ancestors(a) for a in ankles]
        self.pelvis = next(j for j in chains[0] if j in chains[1])
        self.hip, self.knee, self.ankle, self.toe, self.toe_end = [], [], list(ankles), [], []
        for side, chain in zip(SIDES, chains):
            chain = chain[:chain.index(self.pelvis)]  # from the ankle up to the joint below the pelvis
            hip, knee = self._hip_and_knee(chain)
            self.hip.append(hip)
            self.knee.append(knee)
            toe = b.index(self.summary[f"{side}_toe_joint"])
            self.toe.append(toe)
            end = toe
            while b.children(end):
                end = b.children(end)[-1]
            self.toe_end.append(end)
        self.leg_joints = [[j for j in chain[:chain.index(self.pelvis)]] +
                           [j for j in self.below(a) if not b.end_site[j]]
                           for chain, a in zip(chains, ankles)]

    def below(self, joint):
        found = []
        for child in self.bvh.children(joint):
            found += [child] + self.below(child)
        return found

    def _hip_and_knee(self, chain):
        """The pair of joints whose two bones add up to leg_length_m and are most alike."""
        p, best = self.position[0], None
        for k in range(1, len(chain)):
            for h in range(k + 1, len(chain)):
                thigh = np.linalg.norm(p[chain[h]] - p[chain[k]])
                shank = np.linalg.norm(p[chain[k]] - p[chain[0]])
                score = 10 * abs(thigh + shank - self.leg_length) + abs(thigh - shank)
                if best is None or score < best[0]:
                    best = (score, chain[h], chain[k])
        return best[1], best[2]

    def _find_points(self):
        self.heel_fk, self.toe_fk, self.toe_end_fk, self.heel, self.toe_csv = [], [], [], [], []
        for i, side in enumerate(SIDES):
            offset = np.array(self.summary[f"{side}_heel_offset_m"])
            a = self.ankle[i]
            self.heel_fk.append(self.position[:, a] + self.rotation[:, a] @ offset)
            self.toe_fk.append(self.position[:, self.toe[i]])
            self.toe_end_fk.append(self.position[:, self.toe_end[i]])
            self.heel.append(self.points(f"{side}_heel"))
            self.toe_csv.append(self.points(f"{side}_toe"))
        self.root = self.points("root")
        self.toe_rest = [float(self.summary[f"{s}_toe_rest_m"]) for s in SIDES]
        heading = self.col["heading_rad"]
        self.forward = np.stack([np.sin(heading), 0 * heading, np.cos(heading)], -1)
        self.leftward = np.stack([np.cos(heading), 0 * heading, -np.sin(heading)], -1)

    def points(self, stem):
        return np.stack([self.col[f"{stem}_{a}_m"] for a in "xyz"], -1)

    def _stick_changes(self):
        x, y = self.col["stick_x"], self.col["stick_y"]
        return list(np.nonzero((np.diff(x) != 0) | (np.diff(y) != 0))[0] + 1)

    def _find_landings(self):
        """landings[side]: first roll tick after that foot's flight; lift_offs: first flight tick."""
        stage, swing = self.col["stage"], self.col["swing"]
        self.landings, self.lift_offs = [], []
        for side in SIDES:
            flight = (stage == "flight") & (swing == side)
            roll = (stage == "roll") & (swing == side)
            self.landings.append(np.nonzero(flight[:-1] & roll[1:])[0] + 1)
            starts = np.nonzero(flight & ~np.concatenate([[False], flight[:-1]]))[0]
            self.lift_offs.append(starts)

    def _find_steady(self, settle_s):
        """steady: walking forward (or straight back), nothing changed for settle_s. walking: stage is not idle."""
        self.walking = self.col["stage"] != "idle"
        marks = np.union1d(self.change_ticks, np.nonzero(np.diff(self.walking.astype(int)))[0] + 1).astype(int)
        last = np.zeros(self.ticks, dtype=int)
        last[marks[marks < self.ticks]] = marks[marks < self.ticks]
        since = np.arange(self.ticks) - np.maximum.accumulate(last)
        self.straight = self.col["stick_x"] == 0
        walks = (self.col["stick_y"] > 0) | (self.straight & (self.col["stick_y"] < 0))
        self.steady = self.walking & (since >= settle_s * self.rate) & walks
        self.turning = ~self.straight | (np.abs(self.col["turn_rate_rad_s"]) > 1e-6)

    @functools.cached_property
    def second_differences(self):
        """The second differences (ticks, joints), degrees per tick^2 at 240 Hz."""
        return bvhs.second_differences(self.local) * (self.rate / 240.0) ** 2

    def cycles(self, side, mask):
        """The cycles as (from, to): neighbouring landings of one foot between which the mask is true."""
        marks = self.landings[side]
        return [(a, b) for a, b in zip(marks[:-1], marks[1:]) if mask[a:b + 1].all()]

    def captured(self):
        return "procedural" not in str(self.summary["motion"]).lower()

    def knee_angles(self, side):
        """The angles between thigh and shank in degrees, negative if the knee is behind the hip-ankle line."""
        hip, knee, ankle = (self.position[:, j] for j in (self.hip[side], self.knee[side], self.ankle[side]))
        thigh, shank = knee - hip, ankle - knee
        size = np.linalg.norm(np.cross(thigh, shank), axis=-1)
        angle = np.degrees(np.arctan2(size, np.sum(thigh * shank, -1)))
        front = np.cross(ankle - hip, self.leftward)
        return np.where(np.sum(front * thigh, -1) < 0, -angle, angle)

    def hip_flexion(self, side):
        """The angles of the thigh against the vertical in the plane of the heading in degrees, forward positive."""
        thigh = self.position[:, self.knee[side]] - self.position[:, self.hip[side]]
        return np.degrees(np.arctan2(np.sum(thigh * self.forward, -1), -thigh[:, 1]))
