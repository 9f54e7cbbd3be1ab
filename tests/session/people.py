#!/usr/bin/python3
"""Sets the built-in walk beside figures that others measured of people: people.py PROGRAM [--json]

- Curves: Schwartz, Rozumalski & Trost 2008 (J Biomech 41:1639), free speed, means of healthy people, every 4 % of a cycle
  from the heel strike on. Figure: RMS of the difference after the walk's mean is laid on theirs (the zero of a joint is the
  lab's), at the stick whose cadence is nearest to 110 a minute; what stands as allowed is the people's own standard
  deviation (hip 6, knee 7, ankle 6 degrees).
- Toe clearance: the least height of the toe above its rest in mid-swing; 11 to 19 mm (Winter 1991; Moosabhoy & Gard 2006).
- Cadence: landings a minute of the steady walk; 95 to 124. First step: from the first landing to the second over the steady
  interval; 1.05 to 1.29. U-turn: with `--stick points` from ahead to back, from the stick's turn until the heading is within
  ten degrees; 1.4 to 2.2 s and 1 to 4 landings. (19 healthy people.)

Exit status 0 also where a figure is outside: it tells, and does not judge.
"""
import argparse
import json
import pathlib
import sys
import tempfile

import numpy as np

if __name__ == "__main__":
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from session.transitions import RATE, Player

# Flexion, flexion, dorsiflexion in degrees at 0, 4 ... 96 % of the cycle.
PEOPLE = {
    "hip": (6, [35.8, 35.5, 34.2, 31.1, 26.9, 22.5, 18.1, 13.6, 9.3, 5.3, 1.6, -1.7, -4.4, -5.8, -4.9, -0.9, 6.1, 14.1, 21.4,
                27.4, 32.0, 35.1, 36.6, 36.5, 35.8]),
    "knee": (7, [5.6, 10.9, 16.9, 19.3, 18.6, 16.5, 13.9, 11.3, 9.0, 7.2, 6.2, 6.8, 9.5, 14.5, 22.6, 33.9, 46.3, 55.7, 59.1,
                 56.9, 49.8, 38.8, 25.5, 12.5, 4.6]),
    "ankle": (6, [-2.1, -5.6, -4.1, -0.2, 2.9, 5.2, 6.8, 8.0, 9.1, 10.2, 11.1, 11.8, 11.5, 8.4, -0.2, -13.8, -19.8, -14.7, -7.9,
                  -2.4, 1.1, 2.5, 1.8, 0.1, -1.1])}
STICKS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
CADENCE, NEAR_CADENCE = (95, 124), 110  # range and goal, steps a minute
FIRST_STEP, TURN_S, TURN_LANDINGS, TOE_MM = (1.05, 1.29), (1.4, 2.2), (1, 4), (11, 19)
ARRIVED_DEG = 10


def landings(walk):
    return np.sort(np.concatenate(walk.landings))


def cadence(walk):
    last = landings(walk)[-7:]
    return 60 * RATE * (len(last) - 1) / (last[-1] - last[0])


def first_step(walk):
    every = landings(walk)
    steady = (every[-1] - every[-7]) / 6
    return (every[1] - every[0]) / steady


def ankle_angles(walk, side):
    """Degrees of the foot's line from ankle to toe against the shank, dorsiflexion positive."""
    shank = walk.position[:, walk.ankle[side]] - walk.position[:, walk.knee[side]]
    foot = walk.position[:, walk.toe[side]] - walk.position[:, walk.ankle[side]]
    pitch = lambda line: np.arctan2(np.sum(line * walk.forward, -1), -line[:, 1])
    return np.degrees(pitch(foot) - pitch(shank))


def differences(walk, side=0):
    """The differences {joint: RMS degrees} of the last whole cycle of that leg."""
    a, b = walk.landings[side][-2:]
    own = {"hip": walk.hip_flexion(side), "knee": walk.knee_angles(side), "ankle": ankle_angles(walk, side)}
    places = a + (b - a) * np.arange(25) / 25
    found = {}
    for joint, (_, theirs) in PEOPLE.items():
        ours = np.interp(places, np.arange(len(own[joint])), own[joint])
        gap = ours - np.array(theirs)
        found[joint] = float(np.sqrt(np.mean((gap - gap.mean()) ** 2)))
    return found


def toe_clearance_mm(walk, side=0):
    """Smallest local minimum of the toe's height in a swing."""
    a, b = [lift for lift in walk.lift_offs[side] if lift < walk.landings[side][-1]][-1], walk.landings[side][-1]
    height = 1000 * (walk.toe_fk[side][a:b, 1] - walk.toe_rest[side])
    turns = np.nonzero((np.diff(height)[:-1] < 0) & (np.diff(height)[1:] >= 0))[0] + 1
    return float(height[turns].min()) if len(turns) else None


def u_turns(player):
    """The U-turns as [(seconds, landings)] from different phases of the stride."""
    found = []
    for k in range(8):
        turn_s = 4.0 + 0.14 * k
        walk = player.walk((0.5, 0, 0.8), (turn_s, 0, -0.8), end_s=turn_s + 5)
        since = int(turn_s * RATE)
        heading = np.degrees(walk.col["heading_rad"])
        arrived = np.nonzero(np.abs(np.abs(heading[since:] - heading[since]) - 180) < ARRIVED_DEG)[0]
        if len(arrived) == 0:
            raise SystemExit(f"people.py: no U-turn within 5 s from {turn_s} s on")
        end = since + int(arrived[0])
        landed = landings(walk)
        found.append(((end - since) / RATE, int(((landed > since) & (landed <= end)).sum())))
    return found


def row(name, values, bounds, unit, where=""):
    """A row with the value that is farthest out of bounds, else with the first value."""
    low, high = bounds
    outside = [v for v in values if not low <= v <= high]
    worst = max(values, key=lambda v: max(low - v, v - high)) if len(values) > 1 else values[0]
    return {"name": name, "worst": float(worst), "unit": unit, "allowed": f"{low}..{high}", "runs": len(values),
            "failed": len(outside), "where": where}


def rows_of(program, folder):
    player = Player(program, folder)
    walks = {stick: player.walk((0.5, 0, stick), end_s=10.0) for stick in STICKS}
    paces = {stick: cadence(walk) for stick, walk in walks.items()}
    near = min(STICKS, key=lambda stick: abs(paces[stick] - NEAR_CADENCE))
    label = f"stick {near}: {paces[near]:.0f} a minute"
    rows = [row(f"{joint}: RMS off the people's mean", [value], (0, PEOPLE[joint][0]), "deg", label)
            for joint, value in differences(walks[near]).items()]
    clearance = toe_clearance_mm(walks[near])
    if clearance is not None:
        rows.append(row("least toe clearance in mid-swing", [clearance], TOE_MM, "mm", label))
    rows += [row(f"cadence at stick {stick}", [paces[stick]], CADENCE, "a minute") for stick in STICKS]
    rows.append(row("first landing interval over the steady one", [first_step(walk) for walk in walks.values()], FIRST_STEP, "x",
                    f"sticks {STICKS[0]} to {STICKS[-1]}"))
    turns = u_turns(Player(program, folder, options=("--stick", "points")))
    rows.append(row("U-turn", [s for s, _ in turns], TURN_S, "s", "8 moments of the stride"))
    rows.append(row("landings in a U-turn", [n for _, n in turns], TURN_LANDINGS, "", "8 moments of the stride"))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--json", action="store_true", help="rows for tools/measured.py")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        rows = rows_of(options.program.resolve(), folder)
    if options.json:
        print(json.dumps(rows, indent=1))
        return
    for r in rows:
        print(f"{r['name']:46}{r['worst']:9.3g} {r['unit']:10}{r['allowed']:>12}  {r['failed']} of {r['runs']} outside  {r['where']}")


if __name__ == "__main__":
    main()
