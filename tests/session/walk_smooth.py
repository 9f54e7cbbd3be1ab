"""Second differences of joint rotations: legs against fixed bounds, the rest against the capture."""
import numpy as np

import bvh_fk
from walk_bounds import Check, worst

FAST_M_S, FAST_LEG_M = 1.3, 0.84
HARMONICS = 10


def leg_checks(w):
    """Degrees per tick^2 at 240 Hz. Rotation vector of one tick's turn, so frame and wrap play no part."""
    d2 = bvh_fk.second_differences(w.local) * (w.rate / 240.0) ** 2
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
    joints = chain + toes
    per_joint = ", ".join(f"{w.bvh.names[j]} {d2[:, j].max():.2f}@{int(d2[:, j].argmax())}" for j in joints)
    checks.append(Check("leg d2 by joint", None, note=per_joint))
    plain = _plain_second_differences(w.local[:, joints])
    checks.append(Check("leg d2, plain rotation vectors", worst(plain) * (w.rate / 240.0) ** 2, unit="deg/tick2"))
    return checks


def _leg_bounds(w):
    """Per tick: 0.5 steady default, 1.0 changes and captured, 5 captured and faster than the limit."""
    bound = np.where(w.steady, 0.5, 1.0)
    if w.captured():
        limit = FAST_M_S * np.sqrt(w.leg_length / FAST_LEG_M)
        fast = w.col["speed_m_s"] > limit
        reach = int(1.5 * w.rate)
        near = np.convolve(fast.astype(int), np.ones(2 * reach + 1, dtype=int), "same")[:w.ticks] > 0
        bound = np.where(near, 5.0, 1.0)
    return bound, " (fast)"


def _worst_joint(w, d2, joints, part):
    values = d2[np.ix_(part, joints)]
    tick, joint = np.unravel_index(int(values.argmax()), values.shape)
    k = part[tick]
    return float(values.max()), f"{w.bvh.names[joints[joint]]}, tick {k}, {w.col['stage'][k]} {w.col['swing'][k]}"


def _plain_second_differences(local):
    q = bvh_fk.quaternions(local)
    half = np.arctan2(np.linalg.norm(q[..., 1:], axis=-1), q[..., 0])
    size = np.maximum(np.sin(half), 1e-12)
    v = np.degrees(2 * (half / size))[..., None] * q[..., 1:]
    return np.linalg.norm(v[2:] - 2 * v[1:-1] + v[:-2], axis=-1)


# ---- hips and everything above -----------------------------------------------------------------
def upper_joints(w):
    legs = set(w.leg_joints[0] + w.leg_joints[1])
    for side in range(2):
        legs |= set(w.below(w.hip[side]))
    return [j for j in range(len(w.bvh.names)) if j not in legs and w.bvh.channels[j]]


def upper_checks(w, source=None):
    """At most 0.2 over the captured curve's own. Without a source the walk's own harmonics stand for it."""
    joints = upper_joints(w)
    cycles = w.cycles(1, w.steady)
    d2 = bvh_fk.second_differences(w.local) * (w.rate / 240.0) ** 2
    changing = np.nonzero(~w.steady)[0]
    value, where = _worst_joint(w, d2, joints, changing)
    checks = [Check("hips and above d2, changing", value, unit="deg/tick2", note=where)]
    if not cycles:
        return checks
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
    return checks + [Check("hips and above d2 over the capture's", float(excess.max()), 0.2, unit="deg/tick2",
                           note=note)]


def _harmonic_second_differences(w, joints, cycle):
    a, b = cycle
    q = bvh_fk.quaternions(w.local[a:b, joints])
    spectrum = np.fft.rfft(q, axis=0)
    spectrum[HARMONICS + 1:] = 0
    smooth = bvh_fk.matrices_of(np.fft.irfft(spectrum, n=b - a, axis=0))
    around = np.concatenate([smooth[-1:], smooth, smooth[:1]])
    return bvh_fk.second_differences(around).max(0) * (w.rate / 240.0) ** 2


def _source_second_differences(w, source, joints, cycle):
    """Cubic spline through the captured frames that this cycle came from, sampled at the cycle's pace."""
    names = [w.bvh.names[j] for j in joints]
    if any(n not in source.names for n in names):
        return None, ""
    local = bvh_fk.local_rotations(source)[:, [source.index(n) for n in names]]
    q = bvh_fk.quaternions(local)
    a, b = cycle
    ours = bvh_fk.quaternions(w.local[a:b, joints])
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
    d2 = bvh_fk.second_differences(bvh_fk.matrices_of(smooth)) * (w.rate / 240.0) ** 2
    used = np.isin(np.round(places).astype(int), np.unique(np.concatenate([nearest + s for s in (-2, -1, 0, 1, 2)])))
    return d2[used].max(0), f"source frames {nearest.min()}-{nearest.max()}, {pace:.3f} a tick"


def _spline(values, places):
    """Natural cubic spline through values (N, C) at 0..N-1."""
    n = len(values)
    matrix = np.eye(n)
    right = np.zeros_like(values)
    inner = np.arange(1, n - 1)
    matrix[inner, inner] = 4.0
    matrix[inner, inner - 1] = matrix[inner, inner + 1] = 1.0
    right[1:-1] = 6 * (values[2:] - 2 * values[1:-1] + values[:-2])
    second = np.linalg.solve(matrix, right)
    low = np.clip(places.astype(int), 0, n - 2)
    t = (places - low)[:, None]
    s = 1 - t
    return (s * values[low] + t * values[low + 1] +
            ((s ** 3 - s) * second[low] + (t ** 3 - t) * second[low + 1]) / 6)
