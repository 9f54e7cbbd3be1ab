"""Lints an exported clip as a game's import would: pose.glb alone is read, by code of its own (support/glb.py); which
points the walk plants, and when, is what frames.csv claims.

- Loop: one to four strides of the steady walk, as many as end nearest to a whole frame. Closure: the largest angle between
  a joint at the first frame and at the frame that would follow the last one. Seam: by how much a joint's angular velocity
  jumps over the seam, beside the largest jump between two frames of the clip from the loop's begin to where it goes on.
- Root motion: the hips' mean speed over the stride, beside that of the feet that carry it: from plant to plant.
- Flips: neighbouring keys of a rotation whose dot product is negative.
- Slide: how far a planted heel or toe moves while it is planted.
"""
import csv
import functools
import json
import pathlib

import numpy as np

from support.glb import Glb, world

SIDES = ("left", "right")
CLOSURE_DEG, SEAM_TIMES, SPEED_PERCENT, SLIDE_MM = 1.0, 1.05, 1.0, 1.0  # bounds of a clip
UNSTEADY_SHARE = 0.4  # share of the clip that is not steady; the loop is taken after it
MOST_STRIDES = 4


def columns_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def angle_deg(a, b):
    """Degrees between two quaternions x y z w."""
    dot = np.abs(np.sum(a * b, axis=-1)) / (np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1))
    return np.degrees(2 * np.arccos(np.clip(dot, 0, 1)))


def velocity(a, b):
    """The turn from quaternion a to b as a vector (3,), degrees a frame."""
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    conjugate = np.array([-a[0], -a[1], -a[2], a[3]])
    x1, y1, z1, w1 = b
    x2, y2, z2, w2 = conjugate
    vector = np.array([w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2, w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2,
                       w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2])
    vector *= np.sign(w1 * w2 + x1 * -x2 + y1 * -y2 + z1 * -z2) or 1.0
    size = np.linalg.norm(vector)
    return vector * (np.degrees(2 * np.arcsin(min(size, 1.0))) / size if size > 0 else 0.0)


class Clip:
    def __init__(self, folder, suffix=""):
        folder = pathlib.Path(folder)
        self.summary = json.loads((folder / f"summary{suffix}.json").read_text())
        glb = Glb(folder / f"pose{suffix}.glb")
        self.times, moves, self.turns = glb.tracks()
        self.turns = {node: keys.astype(float) for node, keys in self.turns.items()}
        self.position, self.rotation = world(glb, len(self.times), moves, self.turns)
        self.root = next(node for node in moves if glb.parents[node] < 0 or glb.parents[node] not in moves)
        claimed = columns_of(folder / f"frames{suffix}.csv")
        at = np.rint(self.times * float(self.summary["rate_hz"])).astype(int)
        self.planted = {(side, point): claimed[f"{side}_{point}_planted"][at] == "1" for side in SIDES for point in ("heel", "toe")}
        self.track = {}
        for side in SIDES:
            ankle, toe = (glb.names.index(self.summary[f"{side}_{joint}_joint"]) for joint in ("ankle", "toe"))
            heel = np.array(self.summary[f"{side}_heel_offset_m"])
            self.track[side, "heel"] = self.position[:, ankle] + self.rotation[:, ankle] @ heel
            self.track[side, "toe"] = self.position[:, toe]

    def plants(self, side):
        """The first frames in which the heel is planted, in the later part of the clip."""
        planted = self.planted[side, "heel"]
        starts = np.nonzero(planted[1:] & ~planted[:-1])[0] + 1
        return starts[starts > UNSTEADY_SHARE * len(planted)]

    @functools.cached_property
    def loop(self):
        """The loop as (first frame, frame after the last)."""
        plants = self.plants("right")
        pose = lambda i: np.stack([keys[i] for keys in self.turns.values()])
        loops = [(a, b) for n in range(1, MOST_STRIDES + 1) for a, b in zip(plants, plants[n:])]
        assert loops, "the clip holds no steady stride"
        return min(loops, key=lambda loop: round(angle_deg(pose(loop[0]), pose(loop[1])).max(), 3))

    def closure_deg(self):
        a, b = self.loop
        return max(angle_deg(keys[a], keys[b]) for keys in self.turns.values())

    def seam_times(self):
        """The jump over the seam divided by the largest jump inside, of the worst joint that moves at all."""
        a, b = self.loop
        worst = 0.0
        for keys in self.turns.values():
            rates = [velocity(keys[i], keys[i + 1]) for i in range(a, b)]
            rates_on = [*rates, velocity(keys[b], keys[b + 1])]
            inside = max(np.linalg.norm(q - p) for p, q in zip(rates_on, rates_on[1:]))
            seam = np.linalg.norm(rates[0] - rates[-1])
            if seam * self.rate_hz > 1.0:  # deg/s; a smaller jump is invisible
                worst = max(worst, seam / max(inside, 1e-9))
        return worst

    @property
    def rate_hz(self):
        return (len(self.times) - 1) / (self.times[-1] - self.times[0])

    def speed_error_percent(self):
        a, b = self.loop
        way = lambda track: np.linalg.norm((track[b] - track[a])[[0, 2]])
        return 100 * abs(way(self.position[:, self.root]) / max(way(self.track["right", "heel"]), 1e-9) - 1)

    def flips(self):
        return sum(int((np.sum(keys[1:] * keys[:-1], axis=1) < 0).sum()) for keys in self.turns.values())

    def slide_mm(self):
        worst = 0.0
        for key, track in self.track.items():
            planted = np.concatenate([[False], self.planted[key], [False]])
            edges = np.nonzero(planted[1:] != planted[:-1])[0]
            for first, end in zip(edges[::2], edges[1::2]):
                worst = max(worst, np.linalg.norm(track[first:end] - track[first], axis=1).max())
        return 1000 * worst


CHECKS = {  # name: (figure of a clip, unit, the most that is allowed)
    "loop closure": (Clip.closure_deg, "deg", CLOSURE_DEG),
    "velocity jump at the seam over the largest inside": (Clip.seam_times, "x", SEAM_TIMES),
    "root motion's speed against the feet's": (Clip.speed_error_percent, "%", SPEED_PERCENT),
    "quaternion flips": (Clip.flips, "", 0),
    "a planted heel or toe slides": (Clip.slide_mm, "mm", SLIDE_MM),
}


def lint(clip):
    """The figures of a clip, by name."""
    return {name: float(figure(clip)) for name, (figure, _, _) in CHECKS.items()}


def faults(figures):
    return [name for name, value in figures.items() if not value <= CHECKS[name][2]]
