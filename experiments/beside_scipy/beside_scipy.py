"""Draws the times of a Python user's solvers beside those of this project's module.

Call: beside_scipy.py DIR, the folder with runs.csv of measure.py; writes DIR/beside_scipy.png and
DIR/beside_scipy.svg. A panel is a problem: the time of a run against the error of its positions.
Solvers with several methods are drawn by their lower envelope: the shortest time to that error or a
smaller one.
"""

from collections import defaultdict

from matplotlib import ticker

from measurements import read_facts, read_table
from sheet import Sheet, main
from style import COOL, FAINT, WARM, power_of_ten, seconds

# (force, way): words, colour, line, marker.
LOOKS = {
    ("own f", "solve_ivp"): ("solve_ivp on the user's f", COOL[0], (0, (4, 1.8)), "s"),
    ("the scene's f", "solve_ivp"): ("solve_ivp on the scene's f", COOL[2], (0, (4, 1.8)), "s"),
    ("own f", "NumPy"): ("Verlet in NumPy", FAINT, "-", "^"),
    ("own f", "qddot"): ("qddot on the user's f", WARM[0], "-", "o"),
    ("own f, Numba", "qddot"): ("qddot on the user's f, by Numba", WARM[3], "-", "o"),
    ("the scene's f", "qddot"): ("qddot on the scene", WARM[1], "-", "o"),
    ("the scene's f", "accuracy"): ("qddot, an accuracy asked for", WARM[2], "-", "D"),
}
PANEL, GAP, LEFT, TOP, BOTTOM, HEIGHT = 5.2, 0.95, 0.95, 1.35, 0.7, 4.3


def read(folder):
    """Pairs (error, time) by problem and way."""
    runs = defaultdict(lambda: defaultdict(list))
    for row in read_table(folder / "runs.csv"):
        way = "accuracy" if row["method"] == "accuracy=" else row["way"]
        pair = float(row["error_position"]), float(row["time_s"])
        runs[row["problem"], int(row["unknowns"])][row["force"], way].append(pair)
    return runs


def envelope(pairs):
    """Those that nobody with a smaller error is faster than, from coarse to fine."""
    # Going from the most accurate run to coarser ones, a run counts only if it is faster.
    best, front = float("inf"), []
    for error, time in sorted(pairs):
        if time < best:
            best = time
            front.append((error, time))
    return front


def draw(folder):
    """The picture of all panels."""
    runs = read(folder)
    about = read_facts(folder / "runs.json")
    sheet = Sheet(LEFT + len(runs) * PANEL + (len(runs) - 1) * GAP + 0.25, TOP + HEIGHT + BOTTOM)
    title = "How long a Python user waits, to the same error"
    words = "time of a run against the error of positions at its end"
    processor = f"{about['processor']}, one core"
    sheet.head(0.25, (0.28, 14, title), (0.57, 10, f"{words}; {processor}"))
    lines = {}
    for number, ((problem, unknowns), ways) in enumerate(runs.items()):
        axes = sheet.axes(LEFT + number * (PANEL + GAP), TOP, PANEL, HEIGHT)
        axes.set_xscale("log")
        axes.set_yscale("log")
        for key, (words, color, line, marker) in LOOKS.items():
            if key in ways:
                x, y = zip(*envelope(ways[key]))
                lines[words] = axes.plot(x, y, color=color, linestyle=line, marker=marker, label=words,
                                         markersize=4.5, linewidth=1.5)[0]  # fmt: skip
        axes.set_title(f"{problem}, {unknowns} unknowns", size=11, loc="left")
        axes.xaxis.set_major_formatter(ticker.FuncFormatter(lambda v, _: power_of_ten(v)))
        axes.yaxis.set_major_formatter(ticker.FuncFormatter(lambda v, _: seconds(v)))
        axes.minorticks_off()
        axes.grid(True)
        axes.set_xlabel("relative error of positions  (more accurate to the left)")
    sheet.figure.legend(handles=list(lines.values()), loc="center left", ncol=4, frameon=False,
                        bbox_to_anchor=(0.25 / sheet.width, 1 - 0.88 / sheet.height),
                        borderaxespad=0, borderpad=0, fontsize=9.5)  # fmt: skip
    sheet.save_as(folder, "beside_scipy")


if __name__ == "__main__":
    main(draw)
