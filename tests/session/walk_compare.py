"""Bounds that take two walks: mirror, limp, weights, raw playback."""
import numpy as np

import bvh_fk
from walk_bounds import MM, Check, realised_steps, runs, worst
from walk_data import SIDES


# ---- mirror ----------------------------------------------------------------------------------
def _mirror_name(name):
    for a, b in (("Left", "Right"), ("left", "right"), ("LEFT", "RIGHT")):
        if a in name:
            return name.replace(a, b)
        if b in name:
            return name.replace(b, a)
    if len(name) > 1 and name[0] in "lrLR" and (name[1].isupper() or name[1] == "_"):
        return {"l": "r", "r": "l", "L": "R", "R": "L"}[name[0]] + name[1:]
    return name


def mirror_checks(w, twin):
    n = min(w.ticks, twin.ticks)
    heading = worst(np.abs(w.col["heading_rad"][:n] + twin.col["heading_rad"][:n]))
    checks = [Check("ticks differ", abs(w.ticks - twin.ticks), 0, "=="),
              Check("mirrored stick_x, stick_y", worst(np.abs(w.col["stick_x"][:n] + twin.col["stick_x"][:n])) +
                    worst(np.abs(w.col["stick_y"][:n] - twin.col["stick_y"][:n])), 0, "=="),
              Check("mirrored heading", heading, 0, "==", unit="rad")]
    if w.captured():
        return checks
    swap = {"left": "right", "right": "left", "none": "none"}
    stages = (w.col["stage"][:n] != twin.col["stage"][:n]) | \
             (w.col["swing"][:n] != np.array([swap[s] for s in twin.col["swing"][:n]]))
    flip = np.array([-1.0, 1.0, 1.0])
    gap, joint = 0.0, ""
    for j, name in enumerate(w.bvh.names):
        other = _mirror_name(name)
        if other in twin.bvh.names:
            away = np.linalg.norm(w.position[:n, j] - flip * twin.position[:n, twin.bvh.index(other)], axis=-1)
            k = int(away.argmax())
            gap, joint = max((gap, joint), (away[k], f"{name}, tick {k}, {w.col['stage'][k]} {w.col['swing'][k]}"))
    return checks + [Check("stages not mirrored", int(stages.sum()), 0, "==", unit="ticks"),
                     Check("mirrored walk, all joints", MM * gap, 1.0, unit="mm", note=joint),
                     _first_foot_check(w)]


def _first_foot_check(w):
    """The first flying foot follows the turn's sign."""
    flight = np.nonzero(w.col["stage"] == "flight")[0]
    turned = np.nonzero(w.col["stick_x"] != 0)[0]
    if not len(flight) or not len(turned) or turned[0] > flight[0]:
        return Check("first foot against the turn", None, note="no turn at the start")
    wanted = "right" if w.col["stick_x"][turned[0]] > 0 else "left"
    return Check("first foot against the turn", int(w.col["swing"][flight[0]] != wanted), 0, "==")


# ---- limp ------------------------------------------------------------------------------------
def _mean_step(w, side):
    steps = [length for k, length in realised_steps(w, side) if w.steady[k]]
    return float(np.mean(steps)) if steps else float("nan")


def _flights(w, side):
    """(ticks, heel peak in metres) of each steady flight of that foot."""
    mask = (w.col["stage"] == "flight") & (w.col["swing"] == SIDES[side])
    found = [(b - a, w.heel_fk[side][a:b, 1].max()) for a, b in runs(mask)
             if w.steady[a:b].all() and b < w.ticks]
    return np.array(found) if found else np.full((1, 2), np.nan)


def limp_checks(even, limp, side=0):
    """The paper's left limp: stride -50 %, speed +30 %, height -50 % at the same stick."""
    own, other = _mean_step(limp, side), _mean_step(limp, 1 - side)
    plain, limped = _flights(even, side), _flights(limp, side)
    ticks = np.abs(limped[:, 0] - plain[:, 0].mean() / 1.3).max()
    return [Check("limp: left step / right step", own / other, 0.51, "in", low=0.49),
            Check("limp: left flight - even / 1.3", ticks, 1.0, unit="ticks",
                  note=f"{plain[:, 0].mean():.1f} -> {limped[:, 0].mean():.1f}"),
            Check("limp: left heel peak / even's", limped[:, 1].mean() / plain[:, 1].mean(), 0.56, "in", low=0.44,
                  note=f"{MM * plain[:, 1].mean():.0f} -> {MM * limped[:, 1].mean():.0f} mm"),
            Check("limp: right step against even", 100 * abs(other / _mean_step(even, 1 - side) - 1), 2.0, unit="%")]


# ---- weights ---------------------------------------------------------------------------------
def weight_figures(even, other, side):
    """RMS and extremes of the hip's change (degrees) and heel places (mm) over steady walking."""
    n = min(even.ticks, other.ticks)
    mask = even.steady[:n] & other.steady[:n]
    a, b = even.hip_flexion(side)[:n][mask], other.hip_flexion(side)[:n][mask]
    hip = even.hip[side]
    turn = bvh_fk.angle_between(even.local[:n, hip][mask], other.local[:n, hip][mask])
    heel = {}
    for name, marks in (("lift-off", even.lift_offs[side]), ("landing", even.landings[side])):
        marks = [k for k in marks if k < n and mask[k]]
        heel[name] = MM * worst(np.linalg.norm(even.heel_fk[side][marks] - other.heel_fk[side][marks], axis=-1),
                                float("nan"))
    stages = (even.col["stage"][:n] != other.col["stage"][:n]) | (even.col["swing"][:n] != other.col["swing"][:n])
    return {"rms": float(np.sqrt(np.mean((a - b) ** 2))), "rms_turn": float(np.sqrt(np.mean(turn ** 2))),
            "extremes": max(abs(a.max() - b.max()), abs(a.min() - b.min())), "stages": int(stages.sum()), **heel}


def weight_checks(even, other, low, high=None, extremes=None, sides=(0, 1)):
    checks = []
    for side in sides:
        f, name = weight_figures(even, other, side), f"weights, {SIDES[side]}:"
        note = f"as a rotation {f['rms_turn']:.2f}"
        if high is None:
            checks.append(Check(f"{name} hip RMS", f["rms"], low, ">=", unit="deg", note=note))
        else:
            checks.append(Check(f"{name} hip RMS", f["rms"], high, "in", low=low, unit="deg", note=note))
        checks += [Check(f"{name} hip extremes", f["extremes"], extremes, unit="deg"),
                   Check(f"{name} heel at lift-off", f["lift-off"], 1.0, unit="mm"),
                   Check(f"{name} heel at landing", f["landing"], 1.0, unit="mm"),
                   Check(f"{name} stage ticks differ", f["stages"], 0, "==")]
    return checks


# ---- raw playback ----------------------------------------------------------------------------
def _scaled_offsets(source, w):
    """The source's translations in metres, every bone as long as the character's."""
    scale = float(w.summary["metres_per_unit"])
    moves = bvh_fk.translations(source) * scale
    ours = dict(zip(w.bvh.names, w.bvh.offsets))
    for j, name in enumerate(source.names):
        if source.parents[j] >= 0 and name in ours:
            size = np.linalg.norm(ours[name]) * scale
            old = np.linalg.norm(moves[0, j])
            moves[:, j] *= size / old if old > 1e-9 else 1.0
    return moves


def _contacts(heel, toe, leg):
    """Stretches in which the slower of heel and toe moves at less than 15 % of the fast swing speed."""
    def speed(track):
        return np.linalg.norm(np.gradient(track, axis=0)[:, [0, 2]], axis=-1)
    fast = np.percentile(speed(toe), 95)
    return {"heel": runs((speed(heel) < 0.15 * fast) & (heel[:, 1] < np.percentile(heel[:, 1], 5) + 0.03 * leg)),
            "toe": runs((speed(toe) < 0.15 * fast) & (toe[:, 1] < np.percentile(toe[:, 1], 5) + 0.03 * leg))}


def raw_checks(w, source):
    """The same frames on this character's bones, nothing adapted: how far a foot slides while the
    source's own foot stands. Root as in the file (scaled by the legs' ratio in the second figure)."""
    scale = float(w.summary["metres_per_unit"])
    local = bvh_fk.local_rotations(source)
    true, turned = bvh_fk.forward_kinematics(source.parents, bvh_fk.translations(source) * scale, local)
    moves = _scaled_offsets(source, w)
    ratio = w.leg_length / float(w.summary["source_leg_length_m"])
    figures = []
    for factor in (1.0, ratio):
        root = moves.copy()
        root[:, 0] *= factor
        played, played_turn = bvh_fk.forward_kinematics(source.parents, root, local)
        figures.append(_raw_slides(w, source, ratio, true, turned, played, played_turn))
    ours = max(MM * worst(np.linalg.norm(track[a:b] - track[a], axis=-1))
               for i, side in enumerate(SIDES)
               for name, track in (("heel", w.heel_fk[i]), ("toe", w.toe_fk[i]))
               for a, b in runs(w.col[f"{side}_{name}_planted"]))
    return [Check("raw playback slides, root as in the file", figures[0], unit="mm", note="worst contact"),
            Check("raw playback slides, root scaled", figures[1], unit="mm", note="worst contact"),
            Check("ours slides", ours, 0.1, unit="mm")]


def _raw_slides(w, source, ratio, true, turned, played, played_turn):
    slides = []
    for i, side in enumerate(SIDES):
        ankle, toe = source.index(w.summary[f"{side}_ankle_joint"]), source.index(w.summary[f"{side}_toe_joint"])
        offset = np.array(w.summary[f"{side}_heel_offset_m"])
        heels = [p[:, ankle] + r[:, ankle] @ (offset * f)
                 for p, r, f in ((true, turned, 1 / ratio), (played, played_turn, 1.0))]
        spans = _contacts(heels[0], true[:, toe], w.leg_length / ratio)
        for name, track in (("heel", heels[1]), ("toe", played[:, toe])):
            for a, b in spans[name]:
                if (b - a) * source.frame_time > 0.1:
                    slides.append(MM * worst(np.linalg.norm((track[a:b] - track[a])[:, [0, 2]], axis=-1)))
    return worst(slides, float("nan"))
