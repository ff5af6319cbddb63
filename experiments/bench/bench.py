"""Draws how our explicit methods and other people's solvers compare: time over error, by scene.

Call: bench.py DIR, the folder with bench.csv of the program bench; writes DIR/bench.png and
DIR/bench.svg, a panel for each scene. Solid lines are peers with the f that their users write or
with their own f. Dashed lines are the same peers with our f. The wide stroke is the fastest of our
methods.
"""

from matplotlib.lines import Line2D

from measurements import read_table
from names import shown
from sheet import Sheet, main
from style import COOL, FAINT, FRONT, INK, WARM, decades, power_of_ten, seconds, widened

WIDTH, PANEL_WIDTH, PANEL_HEIGHT = 11.6, 4.95, 3.6
LEFT, TOP, ACROSS, DOWN = 0.85, 1.75, 0.75, 0.95
MOST_ERROR, LEAST_ERROR = 1.0, 1e-10
LOOKS = {
    "odeint dopri5": (WARM[0], "o"),
    "odeint McLachlan": (WARM[2], "s"),
    "ARKODE ERK4": (COOL[0], "^"),
    "arkode_dirk4_klu": (COOL[1], "D"),
    "arkode_dirk5_klu": (COOL[2], "v"),
    "cvode_bdf_klu": (COOL[3], "P"),
    "SciPy DOP853": (WARM[3], "X"),
    "SciPy Radau": (WARM[4], "o"),
    "SciPy BDF": (WARM[5], "s"),
    "LAMMPS": (COOL[4], "h"),
    "Bullet soft body": (INK, "D"),
}
FORCES = {"plain": "-", "its own": "-", "ours": (0, (4, 1.8))}


def read(path):
    """The good points by scene, in the order of the table."""
    scenes = {}
    for row in read_table(path):
        points = scenes.setdefault((row["scene"], float(row["until"])), [])
        if row["outcome"] != "reached_end":
            continue
        row["error"], row["time"] = float(row["error_position"]), float(row["time_s"])
        if LEAST_ERROR <= row["error"] <= MOST_ERROR:
            points.append(row)
    return scenes


def front(points):
    """The corners of the staircase of the shortest time for each error or a smaller one."""
    corners, best = [], float("inf")
    for error, time in sorted((p["error"], p["time"]) for p in points):
        if time < best:
            corners += [(error, best)] if corners else []
            corners.append((error, time))
            best = time
    return corners + [(MOST_ERROR, best)] if corners else []


def draw_scene(axes, points):
    """The lines of one scene."""
    ours = [p for p in points if p["side"] == "ours"]
    for reduced, style in (
        ("all", {"color": FRONT, "linewidth": 7, "solid_capstyle": "round"}),
        ("pins", {"color": FAINT, "linewidth": 1.2}),
    ):
        corners = front([p for p in ours if p["reduced"] == reduced])
        if corners:
            axes.plot(*zip(*corners), zorder=1.5, **style)
    for name, (color, marker) in LOOKS.items():
        for force, line in FORCES.items():
            own = [p for p in points if p["solver"] == name and p["force"] == force]
            if not own:
                continue
            axes.plot(
                [p["error"] for p in own],
                [p["time"] for p in own],
                color=color,
                linestyle=line,
                linewidth=1.3,
                marker=marker,
                markersize=3.6,
                markerfacecolor="white" if force == "ours" else color,
                markeredgewidth=0.9,
            )


def style_axes(axes, title, left, bottom):
    """Scales, grid and words of a panel."""
    decades(axes, power_of_ten, seconds, 10)
    axes.set_xlim(LEAST_ERROR, MOST_ERROR)
    axes.set_ylim(*widened(*axes.get_ylim(), 2))
    axes.set_title(title, loc="left", size=11, weight="bold")
    if left:
        axes.set_ylabel("processor time of a run")
    if bottom:
        axes.set_xlabel("error of the positions at the end")


def key(sheet, names):
    """Which line is which, above the panels."""
    lines = [
        Line2D([], [], color=FRONT, linewidth=7, label="fastest of ours"),
        Line2D([], [], color=FAINT, linewidth=1.2, label="… with all unknowns"),
    ]
    for name in names:
        color, marker = LOOKS[name]
        lines.append(
            Line2D([], [], color=color, marker=marker, markersize=4, linewidth=1.3, label=name)
        )
    sheet.figure.legend(
        handles=lines,
        loc="upper left",
        bbox_to_anchor=(LEFT / WIDTH - 0.005, 1 - 0.75 / sheet.height),
        ncols=5,
        frameon=False,
        fontsize=9.5,
    )


def draw(folder):
    """Draws bench.csv."""
    scenes = read(folder / "bench.csv")
    rows = (len(scenes) + 1) // 2
    sheet = Sheet(WIDTH, TOP + rows * (PANEL_HEIGHT + DOWN))
    sheet.text(LEFT, 0.15, "Other solvers beside our methods", size=15, weight="bold", va="top")
    sheet.text(
        LEFT,
        0.46,
        "filled marks: a user's f, or the solver's own; open marks, dashed: the same solver with our f",
        size=10,
        color=FAINT,
        va="top",
    )
    present = {p["solver"] for points in scenes.values() for p in points}
    key(sheet, [name for name in LOOKS if name in present])
    for i, ((scene, until), points) in enumerate(scenes.items()):
        row, column = divmod(i, 2)
        axes = sheet.axes(
            LEFT + column * (PANEL_WIDTH + ACROSS),
            TOP + row * (PANEL_HEIGHT + DOWN),
            PANEL_WIDTH,
            PANEL_HEIGHT,
        )
        draw_scene(axes, points)
        style_axes(axes, f"{shown(scene)}, {until:g} s", column == 0, row == rows - 1)
    sheet.save_as(folder, "bench")


if __name__ == "__main__":
    main(draw)
