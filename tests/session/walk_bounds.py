"""Bounds on contacts, steps, speed and stages of one exported walk. Each function returns Checks."""
import numpy as np

import bvh_fk
from walk_data import COLUMNS, SIDES

MM = 1000.0


class Check:
    """One line of the table. ok is None where there is nothing to judge (a figure for the reader)."""

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
    """(from, to) of each stretch of True, `to` behind the last."""
    edge = np.diff(np.concatenate([[0], np.asarray(mask, dtype=int), [0]]))
    return list(zip(np.nonzero(edge == 1)[0], np.nonzero(edge == -1)[0]))


# ---- the files themselves --------------------------------------------------------------------
def file_checks(w):
    """Header, rows against frames, FK of the pose against the columns, Euler triples nearest."""
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
    """summary.json against the rows."""
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
    """Triples (a, b, c) whose equal (a+180, 180-b, c+180) lies nearer to the frame before."""
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
    """How far the lower of two points sinks below its rest height, and where."""
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
    """(tick, metres) of each landing of that foot: from where the standing heel last stood."""
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
    """Strides 10 and 200 (or the last) of the longest unchanged part, at equal phase, every joint."""
    marks = [0] + list(w.change_ticks) + [w.ticks]
    a, b = max(zip(marks[:-1], marks[1:]), key=lambda p: p[1] - p[0])
    beats = [k for k in w.landings[1] if a <= k < b]
    last = min(200, len(beats) - 1)
    if last < 14:
        return [Check("strides 10 and 200 differ", None, note="fewer than 15 unchanged strides")]
    name = "strides 10 and 200 differ" if last == 200 else "strides 10 and last differ"
    start, end = (_stride_pose(w, beats[n - 1], beats[n]) for n in (10, last))
    gaps = bvh_fk.angle_between(start, end)
    joint = w.bvh.names[int(np.argmax(gaps.max(0)))]
    return [Check(name, worst(gaps), 0.1, unit="deg", note=f"{joint}, last is {last}")]


def _stride_pose(w, a, b):
    """(101, J, 3, 3) local rotations over one stride, root seen from the heading."""
    local = w.local[a:b + 1].copy()
    frame = np.stack([w.leftward, np.tile([0.0, 1.0, 0.0], (w.ticks, 1)), w.forward], -1)[a:b + 1]
    local[:, 0] = np.swapaxes(frame, -1, -2) @ local[:, 0]
    q = bvh_fk.quaternions(local)
    place = np.linspace(0, b - a, 101)
    low = np.minimum(place.astype(int), b - a - 1)
    t = (place - low)[:, None, None]
    return bvh_fk.matrices_of(q[low] * (1 - t) + q[low + 1] * t)


# ---- turning ---------------------------------------------------------------------------------
def fit_circle(points):
    """Least-squares centre and radius of (N, 2)."""
    a = np.column_stack([2 * points, np.ones(len(points))])
    x, z, c = np.linalg.lstsq(a, (points ** 2).sum(-1), rcond=None)[0]
    return np.array([x, z]), float(np.sqrt(c + x * x + z * z))


def circle_checks(w):
    """Landings at constant stick in a turn: on one circle, meeting themselves after 360 degrees."""
    mask = w.steady & ~w.straight
    checks, told = [], []
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
        told.append(radius)
        closing = _closing(points, centre, heading[marks])
        checks.append(Check(f"{SIDES[side]} circle closes", closing if closing is None else MM * closing, 50.0,
                            unit="mm", note="" if closing is not None else "less than a full turn"))
    if len(told) == 2:
        k = np.nonzero(mask)[0][-1]
        wanted = abs(w.col["speed_m_s"][k] / w.col["turn_rate_rad_s"][k])
        checks.append(Check("mean radius / (v / turn rate)", np.mean(told) / wanted))
    return checks


def _closing(points, centre, heading):
    """Largest distance between a landing and where the walk stands at that heading a turn later."""
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
    """Knee range (a bound) and the figures that the eye judges (no bound)."""
    knees = [w.knee_angles(i) for i in range(2)]
    both = np.stack(knees, -1)
    note = lambda at: f"{SIDES[at % 2]}, tick {at // 2}, {w.col['stage'][at // 2]} {w.col['swing'][at // 2]}"
    checks = [Check("smallest knee angle", both.min(), 1.0, ">=", unit="deg", note=note(int(both.argmin()))),
              Check("largest knee angle", both.max(), 150.0, unit="deg", note=note(int(both.argmax())))]
    return checks + _swing_figures(w, knees)


def stance_waves(knee):
    """How often the knee bends and straightens again by 3 degrees or more."""
    waves, rising, extreme = 0, True, knee[0]
    for value in knee:
        extreme = max(extreme, value) if rising else min(extreme, value)
        if rising and value < extreme - 3:
            waves, rising, extreme = waves + 1, False, value
        elif not rising and value > extreme + 3:
            rising, extreme = True, value
    return waves


def _swing_figures(w, knees):
    clear, strike, stance, waves, rise, peak, travel, drop, heel_peak = [], [], [], [], [], [], [], [], []
    for i in range(2):
        toe = w.toe_fk[i][:, 1] - w.toe_rest[i]
        for a, b in w.cycles(i, w.steady):
            lifts = [k for k in w.lift_offs[i] if a < k < b]
            if not lifts:
                continue
            up = lifts[0]
            mid = slice(up + int(0.3 * (b - up)), up + int(0.85 * (b - up)))
            clear.append(MM * toe[mid].min())
            if w.col["stick_y"][b] >= 0:  # backwards a foot lands flat
                strike.append(MM * toe[b])
            stance.append(knees[i][a:a + int(0.4 * (b - a))].max())
            away = [k for k in w.lift_offs[1 - i] if a < k < up]
            waves.append(stance_waves(knees[i][a:up - int(0.1 * (b - a))]) if away else 0)
            rise += [MM * w.heel_fk[i][k, 1] for k in w.landings[1 - i] if a < k <= up]
            drop.append(MM * (w.root[0, 1] - w.root[a:b, 1].mean()))
            peak.append(knees[i][up:b].max())
            travel.append(MM * np.ptp(w.root[a:b, 1]))
            heel_peak.append(MM * w.heel_fk[i][up:b, 1].max())
    if not clear:
        return []
    return [Check("lowest toe clearance in swing", min(clear), unit="mm"),
            Check("lowest toe at heel strike", min(strike, default=None), 0.0, ">=", unit="mm"),
            Check("stance knee bend", max(stance), unit="deg"),
            Check("knee waves in stance", max(waves)),
            Check("heel rise at the other foot's strike", min(rise, default=None), unit="mm"),
            Check("swing knee peak", max(peak), unit="deg"),
            Check("pelvis below its standing height, mean", max(drop), unit="mm"),
            Check("hip height travel", max(travel), unit="mm"),
            Check("heel peak", max(heel_peak), unit="mm")]
