"""Source motions read without the program: BVH, ASF/AMC, and the built-in walk rebuilt from the published curves
that it is made of. Each becomes a Track: joints in the world, frame by frame."""
import pathlib

import numpy as np

from support import bvh as bvhs


class Track:
    """A motion: names, parents; position (F, J, 3) in metres, rotation (F, J, 3, 3), both in the file's world;
    rate_hz."""

    def __init__(self, names, parents, moves_m, local, rate_hz, order=None):
        self.names, self.parents, self.rate_hz = list(names), list(parents), float(rate_hz)
        self.position, self.rotation = bvhs.forward_kinematics(parents, moves_m, local, order)

    def index(self, name):
        return self.names.index(name)

    def tail(self, joint):
        """The joint's last descendant: the end of the toes."""
        while joint in self.parents:
            joint = len(self.parents) - 1 - self.parents[::-1].index(joint)
        return joint


def read_source(path, metres_per_unit, rate_hz):
    if str(path).lower().endswith(".bvh"):
        b = bvhs.read_bvh(path)
        return Track(b.names, b.parents, bvhs.translations(b) * metres_per_unit, bvhs.local_rotations(b), rate_hz)
    names, parents, moves, local = read_acclaim(skeleton_of(path), path)
    return Track(names, parents, moves * metres_per_unit, local, rate_hz, order_of(parents))


# ---- Acclaim -----------------------------------------------------------------------------------
def skeleton_of(amc):
    """The .asf with the same name, else with the name without its last part (walk_01.amc: walk.asf)."""
    amc = pathlib.Path(amc)
    for stem in (amc.stem, amc.stem.rpartition("_")[0]):
        if stem and (amc.parent / f"{stem}.asf").exists():
            return amc.parent / f"{stem}.asf"
    raise ValueError(f"{amc}: no .asf beside it")


def read_asf(path):
    """Reads (bones by name, parent by name, scale of angles to degrees, order of the root's channels)."""
    bones, parents, section, bone, in_degrees, root = {}, {}, "", None, True, []
    for line in pathlib.Path(path).read_text(errors="replace").splitlines():
        words = line.split("#")[0].split()
        if not words:
            continue
        if words[0].startswith(":"):
            section = words[0].lower()
        elif section == ":units" and words[0] == "angle":
            in_degrees = words[1].lower().startswith("deg")
        elif section == ":root" and words[0] == "order":
            root = [w.lower() for w in words[1:]]
        elif section == ":bonedata" and words[0] == "begin":
            bone = {"dof": [], "axis": ([0.0, 0.0, 0.0], "xyz")}
        elif section == ":bonedata" and words[0] == "name":
            bones[words[1]] = bone
        elif section == ":bonedata" and words[0] == "direction":
            direction = np.array(words[1:4], dtype=float)
            bone["direction"] = direction / max(np.linalg.norm(direction), 1e-12)
        elif section == ":bonedata" and words[0] == "length":
            bone["length"] = float(words[1])
        elif section == ":bonedata" and words[0] == "axis":
            bone["axis"] = ([float(w) for w in words[1:4]], words[4].lower())
        elif section == ":bonedata" and words[0] == "dof":
            bone["dof"] = [w.lower() for w in words[1:]]
        elif section == ":hierarchy" and words[0] not in ("begin", "end"):
            parents.update({child: words[0] for child in words[1:]})
    return bones, parents, 1.0 if in_degrees else 180 / np.pi, root


def turns(letters, degrees):
    """The rotations (F, 3, 3) about fixed axes, the first letter first. degrees: (F, letters)."""
    matrix = np.tile(np.eye(3), (len(degrees), 1, 1))
    for i, letter in enumerate(letters):
        matrix = bvhs.axis_matrices(letter.upper(), degrees[:, i]) @ matrix
    return matrix


def read_acclaim(asf, amc):
    """names, parents, moves (F, J, 3) in the file's unit, local rotations with every joint's rest the identity.
    A bone turns at its beginning, which is its parent's end; leaves get NAME_End."""
    bones, above, to_degrees, root = read_asf(asf)
    rows = {}
    for line in pathlib.Path(amc).read_text(errors="replace").splitlines():
        words = line.split("#")[0].split()
        if len(words) > 1:
            rows.setdefault(words[0], []).append([float(w) for w in words[1:]])
    names = ["root", *(n for n in bones if n in above)]
    names += [f"{n}_End" for n in names[1:] if n not in above.values()]
    frames = len(rows["root"])
    moves, local = np.zeros((frames, len(names), 3)), np.tile(np.eye(3), (frames, len(names), 1, 1))
    values = np.array(rows["root"])
    for k, axis in enumerate("xyz"):
        moves[:, 0, k] = values[:, root.index(f"t{axis}")]
    order = [i for i, w in enumerate(root) if w[0] == "r"]
    local[:, 0] = turns([root[i][1] for i in order], values[:, order] * to_degrees)
    parents = [-1]
    for j, name in enumerate(names[1:], 1):
        parent = name[:-4] if name not in bones else above[name]
        parents.append(names.index(parent))
        if parent != "root":
            moves[:, j] = bones[parent]["direction"] * bones[parent]["length"]
        dof = [w[1] for w in bones[name]["dof"] if w[0] == "r"] if name in rows else []
        if dof:
            columns = [i for i, w in enumerate(bones[name]["dof"]) if w[0] == "r"]
            angles, letters = bones[name]["axis"]
            axis = turns(letters, np.array([angles]) * to_degrees)[0]
            local[:, j] = axis @ turns(dof, np.array(rows[name])[:, columns] * to_degrees) @ axis.T
    return names, parents, moves, local


def order_of(parents):
    """The joints, parents first."""
    def depth(j):
        return 0 if j < 0 else 1 + depth(parents[j])
    return sorted(range(len(parents)), key=lambda j: depth(j))


# ---- the built-in walk -------------------------------------------------------------------------
# Six-harmonic fits in degrees over the stride from heel strike: mean, then (cosine, sine) rows. Hip, knee, ankle and
# tilt: gaitutils' normal.gcd; list and turn of the pelvis: Schwartz, Rozumalski & Trost 2008.
CURVES = {
    "hip": (15.42, (22.21, -.64), (-2.67, -2.64), (-1.16, 1.49), (.26, -.07), (-.33, .20), (-.01, .20)),
    "knee": (20.73, (3.50, -22.36), (-18.00, .52), (-3.18, 3.91), (-1.01, -.51), (-1.11, .48), (.04, .08)),
    "ankle": (4.58, (-5.19, 5.45), (3.95, -3.86), (-3.10, -1.59), (.95, 1.46), (1.06, -.49), (-.14, -.08)),
    "tilt": (9.76, (0, 0), (1.16, -.04), (0, 0), (.28, .27), (0, 0), (-.10, .15)),
    "list": (0, (1.85, 2.12), (0, 0), (-1.19, .22)),
    "turn": (0, (3.74, 2.10), (0, 0), (.34, -.37))}
BUILT_IN_RATE_HZ, BUILT_IN_FRAMES = 120.0, 134  # of a single stride
TRACK_M, TOE_REST_M, TOE_END_REST_M = 0.05, 0.02, 0.01
MIRROR = np.diag([-1.0, 1.0, 1.0])


def curve(name, phase):
    mean, *rows = CURVES[name]
    return mean + sum(a * np.cos(2 * np.pi * k * phase) + b * np.sin(2 * np.pi * k * phase)
                      for k, (a, b) in enumerate(rows, 1))


def soft_positive(x, width):
    return np.where(x <= -width, 0, np.where(x >= width, x, (x + width) ** 2 / (4 * width)))


def smoothstep(a, b, x):
    u = np.clip((x - a) / (b - a), 0, 1)
    return u * u * (3 - 2 * u)


def _pelvis(phase, leg_m):
    """The pelvis' place without its height, and its rotation."""
    place = np.zeros((len(phase), 3))
    place[:, 0] = -0.032 * leg_m * np.sin(2 * np.pi * (phase - 0.1))
    place[:, 2] = -0.005 * np.cos(4 * np.pi * phase) - 0.004 * np.sin(4 * np.pi * phase)
    x, y, z = (lambda v, a=a: bvhs.axis_matrices(a, v) for a in "XYZ")
    return place, y(curve("turn", phase)) @ z(-curve("list", phase)) @ x(curve("tilt", phase) - CURVES["tilt"][0])


def _right_leg(phase, body, pelvis, hip_m, thigh_m, shank_m):
    """Local rotations of hip, knee, ankle, toe. The leg's plane leans so that the ankle stays on its track."""
    x = lambda degrees: bvhs.axis_matrices("X", degrees)
    thigh = curve("tilt", phase) - curve("hip", phase)
    shank = thigh + 1.5 + soft_positive(curve("knee", phase) - 1.5, 2.0)
    foot = shank - curve("ankle", phase) + 3.5 * np.cos(2 * np.pi * (phase - 0.33))
    on_floor = 1 - smoothstep(0.58, 0.80, phase) + smoothstep(0.94, 1.0, phase)
    bend = soft_positive(foot, 8) * on_floor
    aside = -TRACK_M - (body + pelvis @ hip_m)[:, 0]
    drop = thigh_m * np.cos(np.radians(thigh)) + shank_m * np.cos(np.radians(shank))
    lean = bvhs.axis_matrices("Z", np.degrees(np.arctan2(aside, np.sqrt(drop ** 2 - aside ** 2))))
    back = np.swapaxes(pelvis, 1, 2), np.swapaxes(lean @ x(shank), 1, 2)
    return back[0] @ lean @ x(thigh), x(shank - thigh), back[1] @ x(foot), x(soft_positive(bend - 45, 20) - bend)


def built_in(walk, phase):
    """(moves (F, J, 3), local (F, J, 3, 3)) on the skeleton of an exported walk, walking on the spot; arms and trunk rest.
    Phase 0 is the strike of the right heel."""
    phase, frames = phase % 1.0, len(phase)
    moves = np.tile(walk.bvh.offsets * float(walk.summary["metres_per_unit"]), (frames, 1, 1))
    local = np.tile(np.eye(3), (frames, len(walk.bvh.names), 1, 1))
    body, local[:, walk.pelvis] = _pelvis(phase, walk.leg_length)
    hip_m = moves[0, walk.hip[1]]
    bones = [np.linalg.norm(moves[0, j]) for j in (walk.knee[1], walk.ankle[1])]
    for side in (0, 1):
        at = phase if side == 1 else (phase + 0.5) % 1.0
        leg = _right_leg(at, *_pelvis(at, walk.leg_length), hip_m, *bones)
        for joint, turn in zip((walk.hip, walk.knee, walk.ankle, walk.toe), leg):
            local[:, joint[side]] = turn if side == 1 else MIRROR @ turn @ MIRROR
    moves[:, walk.pelvis] = body
    # The pelvis is as high as the lower foot asks, smoothed to the third harmonic of a step.
    even = np.arange(256) / 256
    if frames != 256 or not np.array_equal(phase, even):
        height = np.interp(phase, even, built_in(walk, even)[0][:, walk.pelvis, 1], period=1.0)
    else:
        position, rotation = bvhs.forward_kinematics(walk.bvh.parents, moves, local)
        low = []
        for side, name in enumerate(("left", "right")):
            heel = rotation[:, walk.ankle[side]] @ np.array(walk.summary[f"{name}_heel_offset_m"])
            low += [(position[:, walk.ankle[side]] + heel)[:, 1], position[:, walk.toe[side], 1] - TOE_REST_M,
                    position[:, walk.toe_end[side], 1] - TOE_END_REST_M]
        wave = np.fft.rfft(-np.min(low, axis=0))
        wave[7:], wave[1::2] = 0, 0
        height = np.fft.irfft(wave, 256)
    moves[:, walk.pelvis, 1] = height
    return moves, local


def built_in_track(walk, speed_m_s, strides=1):
    """The walk travels along +z, so that a standing foot stands."""
    phase = np.arange(strides * BUILT_IN_FRAMES + 1) / BUILT_IN_FRAMES
    moves, local = built_in(walk, phase)
    moves[:, walk.pelvis, 2] += speed_m_s * phase * BUILT_IN_FRAMES / BUILT_IN_RATE_HZ
    return Track(walk.bvh.names, walk.bvh.parents, moves, local, BUILT_IN_RATE_HZ)
