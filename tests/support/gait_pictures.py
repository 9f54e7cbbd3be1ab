"""Pictures of rows of session/fidelity.py, on white."""
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

INK, GREY, BLUE, RED = "#1f2328", "#8c959f", "#0969da", "#cf222e"  # left is blue, right is red
SHEET_PHASES, PLACE_M, ASIDE_M = 8, 1.9, 0.75


def draw_curves(row, path):
    """Source dashed, walk solid, over one stride: hip, knee, ankle, height of the hips."""
    figure = Figure(figsize=(11, 6.5), facecolor="white", layout="constrained")
    panels = figure.subplots(2, 2, sharex=True).ravel()
    for name, line, width in (("source", "--", 1.2), ("walk", "-", 1.8)):
        curves, place = row["curves"][name], 100 * row["curves"]["phase"]
        for k in range(3):
            for side, colour in enumerate((BLUE, RED)):
                label = ("left", "right")[side] if line == "-" else None
                panels[k].plot(place, curves[:, 3 * side + k], line, color=colour, lw=width, label=label)
        panels[3].plot(place, 1000 * (curves[:, 6] - curves[:, 6].mean()), line, color=INK, lw=width)
    for panel, name in zip(panels, ("hip flexion, degrees", "knee flexion, degrees", "ankle flexion, degrees",
                                    "hips about their mean height, mm")):
        panel.set_ylabel(name)
        panel.grid(color="#d8dee4", lw=0.6)
        panel.spines[["top", "right"]].set_visible(False)
    panels[0].legend(frameon=False)
    for panel in panels[2:]:
        panel.set_xlabel("stride, %")
    figure.suptitle(f"{row['clip']}: source dashed, walk solid; hip / knee / ankle {rms_text(row)} degrees RMS", color=INK)
    figure.savefig(path, dpi=110)


def rms_text(row):
    return " / ".join(f"{v:.1f}" for v in row["rms_deg"])


def bones(stride, parents, phase):
    """[(2 x 2 line seen from the walker's right, which leg or None)], the pelvis above 0, at the frame nearest to phase."""
    def above(joint):
        return [] if joint < 0 else [joint] + above(parents[joint])
    k = int(np.argmin(np.abs((stride.phase - phase + 0.5) % 1.0 - 0.5)))
    p = stride.position[k]
    flat = np.stack([(p - p[stride.pelvis]) @ stride.forward, p @ stride.up], -1)
    hidden = above(stride.pelvis)  # a root on the floor
    found = []
    for joint, parent in enumerate(parents):
        if parent >= 0 and joint not in hidden:
            chain = above(joint)
            side = next((s for s, leg in enumerate(stride.legs) if leg[0] in chain), None)
            found.append((flat[[joint, parent]], side))
    return found


def draw_sheet(rows, path):
    """A line a clip: source (light) and walk beside it at eight phases."""
    columns = 2 if len(rows) > 6 else 1
    lines = -(-len(rows) // columns)
    figure = Figure(figsize=(13 * columns, 1.85 * lines), facecolor="white", layout="constrained")
    panels = figure.subplots(lines, columns, squeeze=False).T.ravel()
    for panel in panels:
        panel.set_axis_off()
    for panel, row in zip(panels, rows):
        looks = ((0, 0, GREY, 0.55), (row["shift"], ASIDE_M, INK, 1.0))
        for stride, parents, (shift, aside, trunk, alpha) in zip(row["strides"], row["parents"], looks):
            floor = min((stride.position[:, leg[3]] @ stride.up).min() for leg in stride.legs)
            for i in range(SHEET_PHASES):
                found = bones(stride, parents, (i / SHEET_PHASES + shift) % 1.0)
                panel.add_collection(LineCollection([line + [PLACE_M * i + aside, -floor] for line, _ in found], alpha=alpha,
                                                    colors=[trunk if s is None else (BLUE, RED)[s] for _, s in found],
                                                    linewidths=1.0))
        panel.set_xlim(-0.6, PLACE_M * SHEET_PHASES)
        panel.set_ylim(-0.1, 1.9)
        panel.set_aspect("equal")
        panel.set_title(f"{row['clip']}  {rms_text(row)}", fontsize=9, color=INK, loc="left", pad=0)
    figure.savefig(path, dpi=80)
