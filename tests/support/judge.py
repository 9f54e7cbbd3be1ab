"""The independent judge of `gaitpad replay --out DIR`: measures every bound that the exported files show."""
import functools

import numpy as np

from support.bvh import (angle_between, forward_kinematics, local_rotations, matrices_of, quaternions, second_differences,
                         translations)
from support.walk import COLUMNS, SIDES

MM = 1000.0
FAST_M_S, FAST_LEG_M = 1.3, 0.84
HARMONICS = 10


class Check:
    """One line of the table. ok is None if the figure has no bound."""

    def __init__(self, name, value, bound=None, kind="<=", unit="", note="", low=None):
        self.name, self.value, self.bound, self.kind = name, value, bound, kind
        self.unit, self.note, self.low = unit, note, low
        self.ok = self._judge()

    def _judge(self):
        if self.bound is None or self.value is None:
            return None
        if not np.isfinite(self.value):
            return False
        if self.kind == "<=":
            return bool(self.value <= self.bound)
        if self.kind == ">=":
            return bool(self.value >= self.bound)
        if self.kind == "in":
            return bool(self.low <= self.value <= self.bound)
        return bool(self.value == self.bound)

    def bound_text(self):
        if self.bound is None:
            return ""
        if self.kind == "in":
            return f"{self.low:g}..{self.bound:g}"
        return f"{self.kind} {self.bound:g}"

    def as_dict(self):
        value = None if self.value is None else float(self.value)
        return {"name": self.name, "value": value, "bound": self.bound_text(), "unit": self.unit,
                "ok": self.ok, "note": self.note}


def worst(values, default=0.0):
    values = np.asarray(values, dtype=float)
    return float(values.max()) if values.size else default


def runs(mask):
    """The runs of True as (from, to), `to` exclusive."""
    edge = np.diff(np.concatenate([[0], np.asarray(mask, dtype=int), [0]]))
    return list(zip(np.nonzero(edge == 1)[0], np.nonzero(edge == -1)[0]))


# ---- the files themselves --------------------------------------------------------------------
def file_checks(w):
    """Checks the header, the rows against the frames, the columns against the pose by FK, and that Euler triples are
    the nearest."""
    numbers = np.stack([v for v in w.col.values() if v.dtype.kind == "f"], -1)
    k = np.arange(w.ticks)
    checks = [
        Check("columns missing or out of order", sum(a != b for a, b in zip(COLUMNS, w.header)) +
              max(0, len(COLUMNS) - len(w.header)), 0, "=="),
        Check("rows minus pose frames", abs(w.ticks - len(w.bvh.data)), 0, "=="),
        Check("rows minus summary ticks", abs(w.ticks - int(w.summary["ticks"])), 0, "=="),
        Check("not finite numbers", int((~np.isfinite(numbers)).sum() + (~np.isfinite(w.bvh.data)).sum()), 0, "=="),
        Check("tick, time_s off", worst(np.abs(w.col["tick"] - k)) +
              worst(np.abs(w.col["time_s"] * w.rate - k)) * (1 if w.ticks else 0), 0.01),
        Check("root OFFSET", worst(np.abs(w.bvh.offsets[0])), 0, "=="),
        Check("frame time * rate - 1", abs(w.bvh.frame_time * w.rate - 1), 1e-4),
        Check("Euler triples not the nearest", _far_triples(w.bvh), 0, "=="),
        Check("ik_failures", int(w.summary["ik_failures"]), 0, "=="),
        Check("largest ik_error", MM * worst([worst(w.col[f"{s}_ik_error_m"]) for s in SIDES]), 0.1, unit="mm"),
    ]
    gaps = [worst(np.linalg.norm(a - b, axis=-1)) for a, b in
            [(w.heel_fk[0], w.heel[0]), (w.heel_fk[1], w.heel[1]), (w.toe_fk[0], w.toe_csv[0]),
             (w.toe_fk[1], w.toe_csv[1]), (w.position[:, w.pelvis], w.root)]]
    checks.append(Check("FK heel/toe/pelvis - columns", MM * max(gaps), 0.05, unit="mm"))
    return checks + _counts(w)


def _counts(w):
    """Checks summary.json against the rows."""
    checks = []
    for i, side in enumerate(SIDES):
        told = int(w.summary[f"steps_{side}"])
        checks.append(Check(f"steps_{side} - landings", abs(told - len(w.landings[i])), 0, "=="))
    p, lengths = w.position[0], []
    for i in range(2):
        lengths.append(np.linalg.norm(p[w.hip[i]] - p[w.knee[i]]) + np.linalg.norm(p[w.knee[i]] - p[w.ankle[i]]))
    # Captured legs differ by a percent or two; the character's length is their mean.
    checks.append(Check("leg_length_m - mean of both", 100 * abs(np.mean(lengths) / w.leg_length - 1), 0.5, unit="%",
                        note=f"left {lengths[0]:.4f}, right {lengths[1]:.4f} m"))
    return checks


def _far_triples(bvh):
    """Triples (a, b, c) whose equal (a+180, 180-b, c+180) is nearer to the frame before."""
    count = 0
    for j, channels in enumerate(bvh.channels):
        columns = [bvh.first[j] + c for c, n in enumerate(channels) if n.lower().endswith("rotation")]
        if len(columns) != 3:
            continue
        angles = bvh.data[:, columns]
        before, now = angles[:-1], angles[1:]
        near = lambda t: t - 360 * np.round((t - before) / 360)
        twin = near(np.stack([now[:, 0] + 180, 180 - now[:, 1], now[:, 2] + 180], -1))
        written = np.abs(now - before).sum(-1)
        count += int((written > np.minimum(np.abs(twin - before).sum(-1),
                                           np.abs(near(now) - before).sum(-1)) + 1e-3).sum())
    return count


# ---- contacts --------------------------------------------------------------------------------
def contact_checks(w):
    slide, height, where = {"heel": 0.0, "toe": 0.0}, {"heel": 0.0, "toe": 0.0}, ""
    for i, side in enumerate(SIDES):
        for point, track, rest in (("heel", w.heel_fk[i], 0.0), ("toe", w.toe_fk[i], w.toe_rest[i])):
            for a, b in runs(w.col[f"{side}_{point}_planted"]):
                move = MM * worst(np.linalg.norm(track[a:b] - track[a], axis=-1))
                if move > slide[point]:
                    slide[point], where = move, f"{side}, ticks {a}-{b - 1}"
                height[point] = max(height[point], MM * worst(np.abs(track[a:b, 1] - rest)))
    checks = [Check("planted heel moves", slide["heel"], 0.1, unit="mm", note=where),
              Check("planted toe moves", slide["toe"], 0.1, unit="mm", note=where),
              Check("planted heel off rest height", height["heel"], 2.0, unit="mm"),
              Check("planted toe off rest height", height["toe"], 2.0, unit="mm")]
    return checks + _floor_checks(w)


def _lowest(w, name, tracks, rests):
    """The depth by which the lower of two points sinks below its rest height, and where."""
    sunk = np.stack([r - t[:, 1] for t, r in zip(tracks, rests)], -1)
    k, side = np.unravel_index(int(np.argmax(sunk)), sunk.shape)
    note = f"{SIDES[side]}, tick {k}, {w.col['stage'][k]} {w.col['swing'][k]}"
    return Check(name, MM * sunk[k, side], 2.0, unit="mm", note=note)


def _floor_checks(w):
    checks = [_lowest(w, "heel below floor", w.heel_fk, (0.0, 0.0)),
              _lowest(w, "toe below its rest height", w.toe_fk, w.toe_rest)]
    idle = np.nonzero(~w.walking)[0]
    if not len(idle):
        return checks + [Check("toe end below its rest height", None, note="never idle: rest height unknown")]
    rest = [t[idle[0], 1] for t in w.toe_end_fk]
    checks.append(_lowest(w, "toe end below its rest height", w.toe_end_fk, rest))
    level = max(abs(w.toe_fk[i][idle[0], 1] - w.toe_rest[i]) for i in range(2))
    checks.append(Check("toe_rest_m against the idle pose", MM * level, 2.0, unit="mm"))
    return checks


# ---- Table I ---------------------------------------------------------------------------------
def stage_checks(w):
    stage, swing = w.col["stage"], w.col["swing"]
    wrong = np.zeros(w.ticks, dtype=bool)
    for i, side in enumerate(SIDES):
        rival = SIDES[1 - i]
        flying, landed = (stage == "flight") & (swing == side), (stage == "roll") & (swing == side)
        away, back = (stage == "flight") & (swing == rival), (stage == "roll") & (swing == rival)
        heel = (stage == "idle") | landed
        toe = (stage == "idle") | away | back
        wrong |= (w.col[f"{side}_heel_planted"] != heel) | (w.col[f"{side}_toe_planted"] != toe)
        wrong |= flying & w.col[f"{side}_heel_planted"]
    wrong |= (stage == "idle") != (swing == "none")
    wrong |= ~np.isin(stage, ["idle", "flight", "roll"]) | ~np.isin(swing, ["left", "right", "none"])
    first = f"first at tick {np.nonzero(wrong)[0][0]}" if wrong.any() else ""
    return [Check("planted columns against Table I", int(wrong.sum()), 0, "==", note=first),
            _order_check(stage, swing)]


def _order_check(stage, swing):
    other = {"left": "right", "right": "left"}
    bad, where = 0, ""
    for k in np.nonzero((stage[1:] != stage[:-1]) | (swing[1:] != swing[:-1]))[0] + 1:
        a, s, b, t = stage[k - 1], swing[k - 1], stage[k], swing[k]
        fine = ((a == "idle" and b in ("roll", "flight")) or (a == "flight" and b == "roll" and t == s) or
                (a == "roll" and b == "flight" and t == other.get(s)) or (a == "roll" and b == "idle"))
        if not fine:
            bad, where = bad + 1, where or f"tick {k}: {a} {s} -> {b} {t}"
    return Check("stages out of order", bad, 0, "==", note=where)


# ---- steps, speed, drift ---------------------------------------------------------------------
def realised_steps(w, side):
    """Each landing of that foot as (tick, metres), measured from the last place of the standing heel."""
    result = []
    standing = 1 - side
    planted = np.nonzero(w.col[f"{SIDES[standing]}_heel_planted"])[0]
    for k in w.landings[side]:
        before = planted[planted < k]
        if len(before):
            step = w.heel_fk[side][k] - w.heel_fk[standing][before[-1]]
            result.append((k, float(step @ w.forward[k])))
    return result


def step_checks(w):
    """Excess over the bound is judged, so one line holds 0.5 %, 1 % and 1 mm; the errors are printed."""
    used, error_mm, error_pc, where = 0.0, 0.0, 0.0, ""
    for side in range(2):
        column = w.col[f"stride_{SIDES[side]}_m"]
        for k, length in realised_steps(w, side):
            told = max((column[k], column[k - 1]), key=lambda c: abs(c - length))
            since = max([0] + [j for j in w.landings[1 - side] if j < k])
            share = 0.01 if w.turning[since:k + 1].any() else 0.005
            error = abs(length - told)
            if error / max(share * abs(told), 0.001) > used:
                used, where = error / max(share * abs(told), 0.001), f"{SIDES[side]}, tick {k}"
                error_mm, error_pc = MM * error, 100 * error / max(abs(told), 1e-9)
    note = f"{error_mm:.3f} mm, {error_pc:.3f} %, {where}" if where else ""
    count = sum(len(x) for x in w.landings)
    return [Check("step length error / allowed", used if count else None, 1.0, note=note)]


def speed_checks(w):
    mask = w.steady & w.straight & ~w.turning
    error, drift, count, note = 0.0, 0.0, 0, ""
    for side in range(2):
        for a, b in w.cycles(side, mask):
            move = w.root[b] - w.root[a]
            told = w.col["speed_m_s"][a:b].mean()
            off = abs(move @ w.forward[a] / ((b - a) / w.rate) / told - 1)
            if off > error:
                error, note = off, f"told {told:.4f} m/s, ticks {a}-{b}"
            drift = max(drift, abs(move @ w.leftward[a]))
            count += 1
    if not count:
        return [Check("root speed error", None, note="no whole steady straight cycle"),
                Check("lateral drift a stride", None)]
    return [Check("root speed error", 100 * error, 1.0, unit="%", note=note),
            Check("lateral drift a stride", MM * drift, 0.1, unit="mm", note=f"{count} cycles")]


def repeat_check(w):
    """Compares strides 10 and 200 (or the last) of the longest unchanged part, at equal phase, in every joint."""
    marks = [0] + list(w.change_ticks) + [w.ticks]
    a, b = max(zip(marks[:-1], marks[1:]), key=lambda p: p[1] - p[0])
    beats = [k for k in w.landings[1] if a <= k < b]
    last = min(200, len(beats) - 1)
    if last < 14:
        return [Check("strides 10 and 200 differ", None, note="fewer than 15 unchanged strides")]
    name = "strides 10 and 200 differ" if last == 200 else "strides 10 and last differ"
    start, end = (_stride_pose(w, beats[n - 1], beats[n]) for n in (10, last))
    gaps = angle_between(start, end)
    joint = w.bvh.names[int(np.argmax(gaps.max(0)))]
    return [Check(name, worst(gaps), 0.1, unit="deg", note=f"{joint}, last is {last}")]


def _stride_pose(w, a, b):
    """The local rotations (101, J, 3, 3) over one stride, with the root seen from the heading."""
    local = w.local[a:b + 1].copy()
    frame = np.stack([w.leftward, np.tile([0.0, 1.0, 0.0], (w.ticks, 1)), w.forward], -1)[a:b + 1]
    local[:, 0] = np.swapaxes(frame, -1, -2) @ local[:, 0]
    q = quaternions(local)
    place = np.linspace(0, b - a, 101)
    low = np.minimum(place.astype(int), b - a - 1)
    t = (place - low)[:, None, None]
    return matrices_of(q[low] * (1 - t) + q[low + 1] * t)


# ---- turning ---------------------------------------------------------------------------------
def fit_circle(points):
    """The least-squares centre and radius of points (N, 2)."""
    a = np.column_stack([2 * points, np.ones(len(points))])
    x, z, c = np.linalg.lstsq(a, (points ** 2).sum(-1), rcond=None)[0]
    return np.array([x, z]), float(np.sqrt(c + x * x + z * z))


def circle_checks(w):
    """Checks landings at constant stick in a turn: they are on one circle, and meet after 360 degrees."""
    mask = w.steady & ~w.straight
    checks = []
    for side in range(2):
        marks = np.array([k for k in w.landings[side] if mask[k]], dtype=int)
        heading = w.col["heading_rad"]
        if len(marks) < 5 or abs(heading[marks[-1]] - heading[marks[0]]) < np.pi:
            continue
        points = w.heel_fk[side][marks][:, [0, 2]]
        centre, radius = fit_circle(points)
        spread = worst(np.abs(np.linalg.norm(points - centre, axis=-1) / radius - 1))
        checks.append(Check(f"{SIDES[side]} landings off their circle", 100 * spread, 2.0, unit="%",
                            note=f"radius {radius:.3f} m, {len(marks)} landings"))
        closing = _closing(points, centre, heading[marks])
        checks.append(Check(f"{SIDES[side]} circle closes", closing if closing is None else MM * closing, 50.0,
                            unit="mm", note="" if closing is not None else "less than a full turn"))
    return checks


def _closing(points, centre, heading):
    """The largest distance of a landing from the landing at that heading a turn later."""
    radius = np.linalg.norm(points - centre, axis=-1)
    angle = np.unwrap(np.arctan2(points[:, 0] - centre[0], points[:, 1] - centre[1]))
    sign = np.sign(heading[-1] - heading[0])
    course, wanted = heading * sign, heading * sign + 2 * np.pi
    wanted = wanted[wanted <= course[-1]]
    if not len(wanted):
        return None
    r, phi = np.interp(wanted, course, radius), np.interp(wanted, course, angle)
    later = centre + np.column_stack([r * np.sin(phi), r * np.cos(phi)])
    return worst(np.linalg.norm(later - points[:len(later)], axis=-1))


# ---- how it looks ----------------------------------------------------------------------------
def look_checks(w):
    """Checks the knees' range, and that a foot strikes with its heel."""
    both = np.stack([w.knee_angles(i) for i in range(2)], -1)
    note = lambda at: f"{SIDES[at % 2]}, tick {at // 2}, {w.col['stage'][at // 2]} {w.col['swing'][at // 2]}"
    checks = [Check("smallest knee angle", both.min(), 1.0, ">=", unit="deg", note=note(int(both.argmin()))),
              Check("largest knee angle", both.max(), 150.0, unit="deg", note=note(int(both.argmax())))]
    strike = [MM * (w.toe_fk[i][b, 1] - w.toe_rest[i]) for i in range(2) for _, b in w.cycles(i, w.steady)
              if w.col["stick_y"][b] >= 0]  # backwards a foot lands flat
    return checks + [Check("lowest toe at heel strike", min(strike), 0.0, ">=", unit="mm")] if strike else checks


# ---- second differences of joint rotations: legs against fixed bounds, the rest against the capture
def leg_checks(w):
    """Second differences in degrees per tick^2 at 240 Hz, of the rotation vector of one tick's turn, so that frames
    and wraps do not matter."""
    d2 = w.second_differences
    bound, kind = _leg_bounds(w)
    checks = []
    toes = sorted(j for i in range(2) for j in w.leg_joints[i] if j in w.below(w.ankle[i]))
    chain = sorted(set(w.leg_joints[0] + w.leg_joints[1]) - set(toes))
    for group, part in (("leg", chain), ("toe joint", toes)):
        for name, mask in (("steady", w.steady), ("changing", ~w.steady)):
            for limit in sorted(set(bound[mask])) if part else ():
                value, where = _worst_joint(w, d2, part, np.nonzero(mask & (bound == limit))[0])
                checks.append(Check(f"{group} d2, {name}{kind if limit >= 5 else ''}", value, limit,
                                    unit="deg/tick2", note=where))
    return checks


def _leg_bounds(w):
    """The bound in each tick: 0.5 steady default, 1.0 steady captured, 1.2 changes, 5 captured and faster than the
    limit."""
    bound = np.where(w.steady, 0.5, 1.2)
    if w.captured():
        limit = FAST_M_S * np.sqrt(w.leg_length / FAST_LEG_M)
        fast = w.col["speed_m_s"] > limit
        reach = int(1.5 * w.rate)
        near = np.convolve(fast.astype(int), np.ones(2 * reach + 1, dtype=int), "same")[:w.ticks] > 0
        bound = np.where(near, 5.0, np.where(w.steady, 1.0, 1.2))
    return bound, " (fast)"


def _worst_joint(w, d2, joints, part):
    values = d2[np.ix_(part, joints)]
    tick, joint = np.unravel_index(int(values.argmax()), values.shape)
    k = part[tick]
    return float(values.max()), f"{w.bvh.names[joints[joint]]}, tick {k}, {w.col['stage'][k]} {w.col['swing'][k]}"


# ---- hips and everything above -----------------------------------------------------------------
def upper_joints(w):
    legs = set(w.leg_joints[0] + w.leg_joints[1])
    for side in range(2):
        legs |= set(w.below(w.hip[side]))
    return [j for j in range(len(w.bvh.names)) if j not in legs and w.bvh.channels[j]]


def upper_checks(w, source=None):
    """Checks that they exceed the captured curve's own by at most 0.2. Without a source the walk's own harmonics
    replace it."""
    joints = upper_joints(w)
    cycles = w.cycles(1, w.steady)
    d2 = w.second_differences
    if not cycles:
        return []
    own, note = None, "own harmonics"
    if source is not None:
        own, note = _source_second_differences(w, source, joints, cycles[-1])
    if own is None:
        own = _harmonic_second_differences(w, joints, cycles[-1])
    steady = np.nonzero(w.steady)[0]
    excess = d2[np.ix_(steady, joints)].max(0) - own
    j = int(np.argmax(excess))
    k = steady[int(d2[steady, joints[j]].argmax())]
    note = f"{w.bvh.names[joints[j]]} {d2[k, joints[j]]:.3f} over {own[j]:.3f} ({note}), tick {k}"
    return [Check("hips and above d2 over the capture's", float(excess.max()), 0.2, unit="deg/tick2", note=note)]


def _harmonic_second_differences(w, joints, cycle):
    a, b = cycle
    q = quaternions(w.local[a:b, joints])
    spectrum = np.fft.rfft(q, axis=0)
    spectrum[HARMONICS + 1:] = 0
    smooth = matrices_of(np.fft.irfft(spectrum, n=b - a, axis=0))
    around = np.concatenate([smooth[-1:], smooth, smooth[:1]])
    return second_differences(around).max(0) * (w.rate / 240.0) ** 2


@functools.lru_cache(maxsize=2)
def _source_quaternions(source, names):
    return quaternions(local_rotations(source)[:, [source.index(n) for n in names]])


def _source_second_differences(w, source, joints, cycle):
    """The second differences of a cubic spline through the captured frames of this cycle, sampled at the cycle's pace.
    """
    names = [w.bvh.names[j] for j in joints]
    if any(n not in source.names for n in names):
        return None, ""
    q = _source_quaternions(source, tuple(names))
    a, b = cycle
    ours = quaternions(w.local[a:b, joints])
    arms = [i for i, j in enumerate(joints) if j not in (0, w.pelvis)] or list(range(len(joints)))
    dots = np.einsum("kjc,fjc->kfj", ours[:, arms], q[:, arms])
    nearest = np.argmax((dots ** 2).sum(-1), axis=1)
    span = 12
    pace = np.diff(nearest[::span]) / span
    pace = pace[(pace > 0) & (pace < 4 * np.median(np.abs(pace)) + 1e-9)]
    if not len(pace):
        return None, ""
    pace = float(np.median(pace))
    low, high = max(0, nearest.min() - 2), min(len(q) - 1, nearest.max() + 2)
    places = np.arange(low, high, pace)
    shape = q.shape[1:]
    smooth = _spline(q.reshape(len(q), -1), places).reshape((len(places),) + shape)
    d2 = second_differences(matrices_of(smooth)) * (w.rate / 240.0) ** 2
    used = np.isin(np.round(places).astype(int), np.unique(np.concatenate([nearest + s for s in (-2, -1, 0, 1, 2)])))
    return d2[used].max(0), f"source frames {nearest.min()}-{nearest.max()}, {pace:.3f} a tick"


def _spline(values, places):
    """Natural cubic spline through values (N, C) at 0..N-1; elimination of its tridiagonal system, 1 4 1."""
    n = len(values)
    second, share = np.zeros_like(values), np.zeros(n)
    second[1:-1] = 6 * (values[2:] - 2 * values[1:-1] + values[:-2])
    for i in range(1, n - 1):
        share[i] = 1 / (4 - share[i - 1])
        second[i] = (second[i] - second[i - 1]) * share[i]
    for i in range(n - 2, 0, -1):
        second[i] -= share[i] * second[i + 1]
    low = np.clip(places.astype(int), 0, n - 2)
    t = (places - low)[:, None]
    s = 1 - t
    return (s * values[low] + t * values[low + 1] +
            ((s ** 3 - s) * second[low] + (t ** 3 - t) * second[low + 1]) / 6)


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
    apart = np.abs(w.col["heading_rad"][:n] + twin.col["heading_rad"][:n])
    # A turn on the spot out of a walk begins with the last foot's landing, and a captured walker's feet are no mirrors.
    on_spot = (w.col["stick_x"][:n] != 0) & (w.col["stick_y"][:n] == 0)
    walks = n if not w.captured() or not on_spot.any() else int(on_spot.argmax())
    heading = worst(apart[:walks])
    checks = [Check("ticks differ", abs(w.ticks - twin.ticks), 0, "=="),
              Check("mirrored stick_x, stick_y", worst(np.abs(w.col["stick_x"][:n] + twin.col["stick_x"][:n])) +
                    worst(np.abs(w.col["stick_y"][:n] - twin.col["stick_y"][:n])), 0, "=="),
              Check("mirrored heading", heading, 1e-6, unit="rad")]  # floats add up to other last bits
    if w.captured():
        return [*checks, Check("mirrored heading on the spot", worst(apart[walks:]), 0.1, unit="rad")]
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
    """Checks that the first flying foot follows the turn's sign."""
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
    """Each steady flight of that foot as (ticks, heel peak in metres)."""
    mask = (w.col["stage"] == "flight") & (w.col["swing"] == SIDES[side])
    found = [(b - a, w.heel_fk[side][a:b, 1].max()) for a, b in runs(mask)
             if w.steady[a:b].all() and b < w.ticks]
    return np.array(found) if found else np.full((1, 2), np.nan)


def limp_checks(even, limp, side=0):
    """Checks the paper's left limp: stride -50 %, speed +30 %, height -50 % at the same stick, of the motion's own
    steps."""
    own, other = _mean_step(limp, side), _mean_step(limp, 1 - side)
    uneven = _mean_step(even, side) / _mean_step(even, 1 - side)
    plain, limped = _flights(even, side), _flights(limp, side)
    ticks = np.abs(limped[:, 0] - plain[:, 0].mean() / 1.3).max()
    return [Check("limp: left step / right step", own / other / uneven, 0.51, "in", low=0.49),
            Check("limp: left flight - even / 1.3", ticks, 1.0, unit="ticks",
                  note=f"{plain[:, 0].mean():.1f} -> {limped[:, 0].mean():.1f}"),
            Check("limp: left heel peak / even's", limped[:, 1].mean() / plain[:, 1].mean(), 0.56, "in", low=0.44,
                  note=f"{MM * plain[:, 1].mean():.0f} -> {MM * limped[:, 1].mean():.0f} mm"),
            Check("limp: right step against even", 100 * abs(other / _mean_step(even, 1 - side) - 1), 2.0, unit="%")]


# ---- weights ---------------------------------------------------------------------------------
def weight_figures(even, other, side):
    """Figures over steady walking: RMS of the change of hip and knee, extremes of the hip's (degrees), places of
    lifting toe and landing heel (mm)."""
    n = min(even.ticks, other.ticks)
    mask = even.steady[:n] & other.steady[:n]
    a, b = even.hip_flexion(side)[:n][mask], other.hip_flexion(side)[:n][mask]
    knee = even.knee_angles(side)[:n][mask] - other.knee_angles(side)[:n][mask]
    heel = {}
    for name, track, marks in (("lift-off", "toe_fk", even.lift_offs[side]), ("landing", "heel_fk", even.landings[side])):
        marks = [k for k in marks if k < n and mask[k]]
        off = getattr(even, track)[side][marks] - getattr(other, track)[side][marks]
        heel[name] = MM * worst(np.linalg.norm(off, axis=-1), float("nan"))
    stages = (even.col["stage"][:n] != other.col["stage"][:n]) | (even.col["swing"][:n] != other.col["swing"][:n])
    return {"rms": float(np.sqrt(np.mean((a - b) ** 2))), "knee_rms": float(np.sqrt(np.mean(knee ** 2))),
            "extremes": max(abs(a.max() - b.max()), abs(a.min() - b.min())), "stages": int(stages.sum()), **heel}


def weight_checks(even, other, low, high=None, extremes=None, sides=(0, 1)):
    """A stiff hip changes itself by `low` at least; a knee that is hardly stiff (with `high`) changes itself by `low` at
    least and the hip by `high` at most."""
    checks = []
    for side in sides:
        f, name = weight_figures(even, other, side), f"weights, {SIDES[side]}:"
        if high is None:
            checks.append(Check(f"{name} hip RMS", f["rms"], low, ">=", unit="deg"))
        else:
            checks += [Check(f"{name} knee RMS", f["knee_rms"], low, ">=", unit="deg"),
                       Check(f"{name} hip RMS of a knee", f["rms"], high, unit="deg")]
        checks += [Check(f"{name} hip extremes", f["extremes"], extremes, unit="deg"),
                   Check(f"{name} toe at lift-off", f["lift-off"], 1.0, unit="mm"),
                   Check(f"{name} heel at landing", f["landing"], 1.0, unit="mm"),
                   Check(f"{name} stage ticks differ", f["stages"], 0, "==")]
    return checks


# ---- raw playback ----------------------------------------------------------------------------
def _scaled_offsets(source, w):
    """The source's translations in metres, every bone as long as the character's."""
    scale = float(w.summary["metres_per_unit"])
    moves = translations(source) * scale
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
    """Measures the source's frames on this character's bones without any adaptation: how far a foot slides while the
    source's own foot stands. The root moves as in the file (scaled by the legs' ratio in the second figure)."""
    scale = float(w.summary["metres_per_unit"])
    local = local_rotations(source)
    true, turned = forward_kinematics(source.parents, translations(source) * scale, local)
    moves = _scaled_offsets(source, w)
    ratio = w.leg_length / float(w.summary["source_leg_length_m"])
    figures = []
    for factor in (1.0, ratio):
        root = moves.copy()
        root[:, 0] *= factor
        played, played_turn = forward_kinematics(source.parents, root, local)
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


# ---- all of it -------------------------------------------------------------------------------
def check_walk(walk, source=None, raw=False):
    checks = (file_checks(walk) + stage_checks(walk) + contact_checks(walk) +
              step_checks(walk) + speed_checks(walk) + repeat_check(walk) +
              circle_checks(walk) + look_checks(walk) + leg_checks(walk) +
              upper_checks(walk, source))
    return checks + (raw_checks(walk, source) if raw and source is not None else [])
