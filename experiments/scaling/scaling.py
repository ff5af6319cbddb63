"""Draws how the cost of a step grows with the number of nodes, and how near f is to the machine.

Call: scaling.py DIR, the folder with scaling.csv, exponents.csv and roofline.csv of the program
scaling; writes DIR/scaling.png and DIR/scaling.svg. Above, a panel a scene: seconds of each phase
over nodes, on wide lines of theory's slopes, and the exponents against theory's. Below, springs a
second against what memory and the processor allow, and the memory of a step.
"""

import numpy as np
from matplotlib import ticker

from labels import Ink, line_label, move_labels
from measurements import read_facts, read_table
from sheet import Sheet, main
from style import FAINT, GRID, INK, Family, Look, decades, power_of_ten, seconds

# Two panels in each row: the scenes and the exponents above, f and the memory of the factors below.
WIDTH = 9.1
LEFT, TOP, PANEL_WIDTH, PANEL_HEIGHT = 0.95, 1.5, 3.8, 3.4
ACROSS, DOWN, LOWER_HEIGHT = 0.3, 0.95, 2.9
ROOF_WIDTH, MEMORY_LEFT, MEMORY_WIDTH = 3.65, 5.75, 3.2
# The names of the phases, left of the exponents.
NAMES = 1.25
FOOT = 0.65
FONT_SIZE = 9
EXPONENTS_SHOWN = 0.6, 2.4

IMPLICIT = Family("implicit", (), "-", True, 1.6)
ONCE = Family("once", (), (0, (1, 1.4)), False, 1.2)
EXPLICIT = Family("explicit", (), (0, (4, 1.8)), False, 1.6)
# Phases by the words and looks they are drawn with.
PHASES = {
    "step": ("whole step", Look("#000000", "o", IMPLICIT)),
    "factorization": ("factorisation", Look("#D55E00", "s", IMPLICIT)),
    "solve": ("solve", Look("#882255", "^", IMPLICIT)),
    "stiffness": ("K", Look("#E69F00", "D", IMPLICIT)),
    "force": ("f", Look("#0072B2", "v", IMPLICIT)),
    "symbolic": ("analysis, once", Look("#7F6A1F", "P", ONCE)),
}
EXPLICIT_STEP = ("{}, whole step", Look("#56B4E9", "o", EXPLICIT))
ITERATED_STEP = ("with conjugate gradients", Look("#555555", "x", EXPLICIT))
SCENES = {
    "chain": Look("#882255", "^", IMPLICIT),
    "cloth": Look("#D55E00", "s", IMPLICIT),
    "lattice": Look("#0072B2", "o", IMPLICIT),
}
# The growth of factorisations and of the fill of the factors by theory, by scene; all else grows as
# n.
FACTORIZATION = {
    "chain": (lambda n: n, "n"),
    "cloth": (lambda n: n**1.5, "n^{3/2}"),
    "lattice": (lambda n: n**2, "n^2"),
}
FILL = {
    "chain": (lambda n: n, "n"),
    "cloth": (lambda n: n * np.log(n), r"n\,\log\,n"),
    "lattice": (lambda n: n ** (4 / 3), "n^{4/3}"),
}
LINEAR = (lambda n: n, "n")


def read(path):
    """The rows of a table, numbers as such where they are some."""
    rows = read_table(path)
    for row in rows:
        for name, value in row.items():
            try:
                row[name] = float(value)
            except ValueError:
                row[name] = value or None
    return rows


def series(rows, number="seconds"):
    """The nodes and numbers of the rows by scene, method and phase."""
    lines = {}
    for row in rows:
        if isinstance(row[number], float):
            key = (row["scene"], row["method"], row["phase"])
            lines.setdefault(key, []).append((row["nodes"], row[number]))
    return {key: np.array(points).T for key, points in lines.items()}


def draw_series(axes, points, look, **style):
    """One line with its marks."""
    line = {"color": look.color, "linestyle": look.family.line, "linewidth": look.family.width}
    axes.plot(*points, zorder=3, **line, **look.marker_style(4.2), **style)


def label_series(axes, drawn):
    """Names every line near one of its points, off all lines. drawn: points, words and look."""
    axes.figure.canvas.draw()
    box = axes.bbox
    bounds = (box.x0 + 4, box.y0 + 4, box.x1 - 4, box.y1 - 4)
    ink = Ink(bounds)
    texts, anchors = [], []
    for points, words, look in drawn:
        pixels = [tuple(axes.transData.transform(point)) for point in np.transpose(points)]
        for start, end in zip(pixels, pixels[1:]):
            ink.add_line(start, end, 2.0)
        if not words:
            continue
        anchors.append(pixels)
        texts.append(line_label(axes, words, look.color, look.text_color, FONT_SIZE))
    move_labels(texts, anchors, ink, axes.transData.inverted().transform)


def law_of(scene, phase):
    """How a phase grows by theory, and that in letters."""
    if phase == "factorization":
        return FACTORIZATION[scene]
    return FILL[scene] if phase in ("solve", "fill") else LINEAR


def draw_law(axes, points, law, color):
    """Theory's growth as a wide faint line through the last of the points; returns its name."""
    n = np.geomspace(points[0][0], points[0][-1], 50)
    cost = law[0](n) * points[1][-1] / law[0](points[0][-1])
    axes.plot(n, cost, color=color, linewidth=6, alpha=0.16, solid_capstyle="butt", zorder=1)
    return rf"$\sim {law[1]}$"


def draw_scene(axes, scene, lines, implicit, explicit):
    """The phases of the implicit method on a scene, and the explicit method's whole step."""
    drawn = []
    for phase, (words, look) in PHASES.items():
        points = lines.get((scene, implicit, phase))
        if points is None:
            continue
        draw_series(axes, points, look)
        if phase in ("factorization", "solve", "force"):
            words = f"{words} {draw_law(axes, points, law_of(scene, phase), look.color)}"
        drawn.append((points, words, look))
    points = lines.get((scene, f"{implicit}:conjugate_gradients", "step"))
    if points is not None:
        words, look = ITERATED_STEP
        draw_series(axes, points, look)
        drawn.append((points, words, look))
    points = lines.get((scene, explicit, "step"))
    if points is not None:
        words, look = EXPLICIT_STEP
        draw_series(axes, points, look)
        drawn.append((points, words.format(explicit), look))
    return drawn


def nodes_words(value):
    """A number of nodes."""
    return f"{value:,.0f}" if value < 1e4 else power_of_ten(value)


def place_of(panel):
    """The left and the top of a panel of the upper rows, by its number."""
    row, column = divmod(panel, 2)
    return LEFT + column * (PANEL_WIDTH + ACROSS), TOP + row * (PANEL_HEIGHT + DOWN)


def draw_scenes(sheet, rows, origin):
    """A panel a scene, all with the same axes."""
    lines = series(rows)
    scenes = [scene for scene in SCENES if any(key[0] == scene for key in lines)]
    implicit = next((key[1] for key in lines if key[2] == "factorization"), None)
    explicit = next(
        (key[1] for key in lines if key[2] == "step" and ":" not in key[1] and key[1] != implicit),
        None,
    )
    panels = []
    for i, scene in enumerate(scenes):
        left, top = place_of(i)
        axes = sheet.axes(left, top, PANEL_WIDTH, PANEL_HEIGHT)
        decades(axes, nodes_words, seconds, FONT_SIZE)
        panels.append((axes, draw_scene(axes, scene, lines, implicit, explicit)))
        sheet.text(left, top - 0.12, scene, size=11, weight="bold", color=INK)
        cut = [c for c in origin["left_out"] if c["scene"] == scene]
        cut = [c["nodes"] for c in cut if c["method"] in (implicit, "")]
        if cut:
            words = f"{implicit} left out from {cut[0]:,.0f} nodes on"
            axes.text(0.99, 0.02, words, size=8.5, color=FAINT, ha="right", transform=axes.transAxes)
    reach = [
        [f(a.get_xlim()[i] for a, _ in panels) for i, f in enumerate((min, max))],
        [f(a.get_ylim()[i] for a, _ in panels) for i, f in enumerate((min, max))],
    ]
    for i, (axes, drawn) in enumerate(panels):
        axes.set_xlim(*reach[0])
        axes.set_ylim(*reach[1])
        axes.set_xlabel("nodes", fontsize=10)
        axes.tick_params(labelleft=i % 2 == 0)
        if i % 2 == 0:
            axes.set_ylabel(f"time of a step of {implicit or explicit}", fontsize=10)
        label_series(axes, drawn)
def springs_words(value):
    """A rate of springs."""
    return f"{value / 1e9:g} G/s" if value >= 1e9 else f"{value / 1e6:g} M/s"


def draw_roofline(sheet, top, rows):
    """Springs a second over the memory that f reads and writes, and what the machine allows."""
    axes = sheet.axes(LEFT, top, ROOF_WIDTH, LOWER_HEIGHT)
    decades(axes, memory_words, springs_words, FONT_SIZE)
    axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
    sheet.text(LEFT, top - 0.5, "f against the machine", size=11, weight="bold", color=INK)
    drawn = []
    for scene, look in SCENES.items():
        own = [row for row in rows if row["scene"] == scene]
        if not own:
            continue
        column = {name: np.array([row[name] for row in own]) for name in own[0] if name != "scene"}
        bytes_held = column["working_set_bytes"]
        points = np.array([bytes_held, column["springs_per_second"]])
        draw_series(axes, points, look)
        drawn.append((points, scene, look))
        limit = np.minimum(
            column["triad_bytes_per_second"] / column["bytes_per_spring"],
            column["peak_flops_per_second"] / column["flops_per_spring"],
        )
        axes.plot(bytes_held, limit, color=look.color, linestyle=(0, (1, 1.2)), linewidth=1.5)
        drawn.append((np.array([bytes_held, limit]), "", look))
    axes.set_xlabel("memory that one evaluation of f reads and writes", fontsize=10)
    axes.set_ylabel("springs a second", fontsize=10)
    low, high = axes.get_ylim()
    axes.set_ylim(low / 1.3, high * 1.2)
    words = (
        "dotted: what the triad's bandwidth and the\n" "peak of multiplications and additions allow"
    )
    sheet.text(LEFT, top - 0.07, words, size=FONT_SIZE, color=FAINT, va="bottom")
    label_series(axes, drawn)


def memory_words(value):
    """An amount of memory with its unit."""
    for unit, scale in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if value >= scale:
            return f"{value / scale:g} {unit}"
    return f"{value:g} B"


def draw_memory(sheet, top, rows):
    """The bytes of the factors over the nodes, with theory's growth."""
    axes = sheet.axes(MEMORY_LEFT, top, MEMORY_WIDTH, LOWER_HEIGHT)
    decades(axes, nodes_words, memory_words, FONT_SIZE)
    words = "Memory of the factors"
    sheet.text(MEMORY_LEFT, top - 0.12, words, size=11, weight="bold", color=INK)
    drawn = []
    for (scene, _, phase), points in series(rows, "bytes").items():
        if phase != "factorization":
            continue
        draw_series(axes, points, SCENES[scene])
        law = draw_law(axes, points, FILL[scene], SCENES[scene].color)
        drawn.append((points, f"{scene} {law}", SCENES[scene]))
    axes.set_xlabel("nodes", fontsize=10)
    label_series(axes, drawn)


def draw_exponents(sheet, place, rows):
    """The exponents with their intervals, and theory's as ticks, a row a phase, at a left and a top."""
    names = {
        "symbolic": "analysis",
        "force": "f",
        "stiffness": "K",
        "factorization": "factorisation",
        "solve": "solve",
        "fill": "factors' memory",
    }
    left, top = place
    axes = sheet.axes(left + NAMES, top, PANEL_WIDTH - NAMES, PANEL_HEIGHT)
    sheet.text(left, top - 0.12, "Exponents, and theory's", size=11, weight="bold", color=INK)
    implicit = next((r["method"] for r in rows if r["phase"] == "factorization"), None)
    own = [row for row in rows if row["method"] == implicit and row["phase"] in names]
    for row in own:
        place = list(names).index(row["phase"]) + 0.24 * (list(SCENES).index(row["scene"]) - 1)
        look = SCENES[row["scene"]]
        axes.plot([row["theory"]] * 2, [place - 0.12, place + 0.12], color=INK, linewidth=1.6)
        if isinstance(row["low"], float):
            axes.plot([row["low"], row["high"]], [place] * 2, color=look.color, linewidth=1.4)
        axes.plot(
            row["exponent"], place, linestyle="none", color=look.color, **look.marker_style(4.5)
        )
    axes.set_yticks(range(len(names)), names.values(), size=FONT_SIZE)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_xlim(*EXPONENTS_SHOWN)
    axes.grid(True, axis="x", color=GRID)
    axes.tick_params(length=0, labelsize=FONT_SIZE)
    axes.spines[["left"]].set_visible(False)
    axes.set_xlabel("with 95 %; black: theory", fontsize=10)


def draw(folder):
    """Draws the picture."""
    origin = read_facts(folder / "scaling.json")
    rows = read(folder / "scaling.csv")
    scenes = len({row["scene"] for row in rows} & set(SCENES))
    # The exponents stand behind the scenes.
    below = place_of(2 * (scenes // 2))[1] + PANEL_HEIGHT + DOWN + 0.35
    sheet = Sheet(WIDTH, below + LOWER_HEIGHT + FOOT)
    largest = max(row["nodes"] for row in rows)
    smallest = min(row["nodes"] for row in rows)
    words = (
        f"{smallest:,.0f} to {largest:,.0f} nodes, one core of {origin['cpu']}; three unknowns a "
        "node, the lattice a cube"
    )
    theory = "wide and faint: how theory lets each phase grow, through its last point"
    title = "How the cost of a step grows"
    sheet.head(0.2, (0.3, 15, title), (0.62, 10, words), (0.86, 10, theory))
    sheet.rule(1.04)
    draw_scenes(sheet, rows, origin)
    draw_exponents(sheet, place_of(scenes), read(folder / "exponents.csv"))
    draw_roofline(sheet, below, read(folder / "roofline.csv"))
    draw_memory(sheet, below, rows)
    sheet.save_as(folder, "scaling")


if __name__ == "__main__":
    main(draw)
