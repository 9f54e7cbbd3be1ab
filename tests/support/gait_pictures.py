"""Pictures of rows of session/fidelity.py, on white."""
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

INK, GREY, BLUE, RED = "#1f2328", "#8c959f", "#0969da", "#cf222e"  # the left leg is blue, the right one red
SHEET_PHASES, PLACE_M, ASIDE_M = 8, 1.9, 0.75


PANELS = ("hip, degrees", "knee, degrees", "ankle, degrees", "pelvis, mm")


def draw_curves(rows, path):
    """One line per clip, source dashed, walk solid, over one stride: flexion of hip, knee, ankle; height of the hips
    about its mean."""
    figure = Figure(figsize=(12.5, 0.55 + 2.15 * len(rows)), facecolor="white", layout="constrained")
    grid = figure.subplots(len(rows), 4, sharex=True, squeeze=False)
    for panels, row in zip(grid, rows):
        for name, line, width in (("walk", "-", 1.5), ("source", (0, (3, 2)), 1.3)):
            curves, place = row["curves"][name], 100 * row["curves"]["phase"]
            for k in range(3):
                for side, colour in enumerate((BLUE, RED)):
                    panels[k].plot(place, curves[:, 3 * side + k], linestyle=line, color=colour, lw=width)
            panels[3].plot(place, 1000 * (curves[:, 6] - curves[:, 6].mean()), linestyle=line, color=INK, lw=width)
        for panel, rms in zip(panels, row["rms_deg"]):
            panel.set_title(f"{rms:.1f} degrees RMS", fontsize=8, color=GREY, loc="right", pad=2)
        panels[0].set_ylabel(row["clip"].rsplit(".", 1)[0], fontsize=9)
    for panel, name in zip(grid[0], PANELS):
        panel.set_title(name, fontsize=10, color=INK, loc="left", pad=2)
    for panel in grid.ravel():
        panel.grid(color="#d8dee4", lw=0.6)
        panel.set_axisbelow(True)
        panel.spines[["top", "right"]].set_visible(False)
        panel.tick_params(labelsize=8)
        panel.set_xlim(0, 100)
    for panel in grid[-1]:
        panel.set_xlabel("stride, %", fontsize=9)
    legend = [Line2D([], [], color=BLUE, label="left"), Line2D([], [], color=RED, label="right"),
              Line2D([], [], color=INK, label="walk"), Line2D([], [], color=INK, ls=(0, (3, 2)), label="capture")]
    figure.legend(handles=legend, loc="upper right", ncol=4, frameon=False, fontsize=9, borderaxespad=0.1)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - 0.24 / figure.get_figheight()))
    figure.savefig(path, dpi=90)


def rms_text(row):
    return " / ".join(f"{v:.1f}" for v in row["rms_deg"])


def bones(stride, parents, phase):
    """Bones as [(2 x 2 line seen from the walker's right, leg or None)], the pelvis above 0, at the frame nearest to
    phase."""
    def above(joint):
        return [] if joint < 0 else [joint] + above(parents[joint])
    k = int(np.argmin(np.abs((stride.phase - phase + 0.5) % 1.0 - 0.5)))
    p = stride.position[k]
    flat = np.stack([(p - p[stride.pelvis]) @ stride.forward, p @ stride.up], -1)
    hidden = above(stride.pelvis)  # the joints above the pelvis of a skeleton whose root is on the floor
    found = []
    for joint, parent in enumerate(parents):
        if parent >= 0 and joint not in hidden:
            chain = above(joint)
            side = next((s for s, leg in enumerate(stride.legs) if leg[0] in chain), None)
            found.append((flat[[joint, parent]], side))
    return found


def draw_sheet(rows, path):
    """One line per clip: source (light) and walk beside it at eight phases."""
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
