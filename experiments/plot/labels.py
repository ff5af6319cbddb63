"""Places the labels of lines in a crowded picture, in pixels."""

import math
from itertools import product

import numpy as np
from matplotlib.text import Text

from sheet import DPI

CELL = 4
GAP = 4
LEADER_FROM = 19.5
DISTANCES = (13, 19, 27, 36, 52, 72, 96, 128, 168, 220, 290, 370)
DIRECTIONS = [2 * math.pi * k / 16 for k in range(16)]
PASSES = 6
OVERLAP_COST = 1000.0
CROSSING_COST = 40.0
DISTANCE_COST = 0.11
LEADER_COST = 1.2
MARKER_INK = 2.0


class Ink:
    """How much is drawn where: a coarse image of the lines and markers labels should not hide."""

    def __init__(self, bounds):
        self.bounds = bounds
        self.left, self.bottom, right, top = bounds
        shape = (int((top - self.bottom) / CELL) + 2, int((right - self.left) / CELL) + 2)
        self.cells = np.zeros(shape)

    def index(self, x, y):
        """The cells of the pixels, those outside moved to the border."""
        return tuple(
            np.minimum(np.maximum(((of - first) / CELL).astype(int), 0), count - 1)
            for of, first, count in zip((y, x), (self.bottom, self.left), self.cells.shape)
        )

    def add_marker(self, center, weight=1.0):
        """Inks the place of one marker: its cell and those around."""
        x, y = (pixel + CELL * np.arange(-1, 2) for pixel in center)
        self.cells[np.ix_(*self.index(x, y))] += weight * MARKER_INK

    def add_line(self, start, end, weight=1.0):
        """Inks a straight line."""
        self.cells[self.index(*points_between(start, end))] += weight

    def add_box(self, box, weight):
        """Inks a box of matplotlib's, which is to stay readable."""
        for y in range(int(box.y0), int(box.y1), CELL):
            self.add_line((box.x0, y), (box.x1, y), weight)

    def in_box(self, box):
        """The ink under a box (left, bottom, right, top)."""
        rows, columns = self.index(np.array(box[0::2]), np.array(box[1::2]))
        return self.cells[rows[0] : rows[1] + 1, columns[0] : columns[1] + 1].sum()

    def along(self, start, end):
        """The ink under a straight line."""
        return self.cells[self.index(*points_between(start, end))].sum()


def points_between(start, end):
    """Points on a straight line, one a cell."""
    count = max(2, int(math.hypot(end[0] - start[0], end[1] - start[1]) / CELL))
    shares = np.arange(count) / (count - 1)
    return (a + (b - a) * shares for a, b in zip(start, end))


class Candidate:
    """One place for a label: its box, the anchor it speaks of and the cost of that alone."""

    def __init__(self, anchor, size, direction, distance, bounds):
        half = (size[0] / 2, size[1] / 2)
        x = anchor[0] + math.cos(direction) * (half[0] + distance)
        y = anchor[1] + math.sin(direction) * (half[1] + distance)
        x = min(max(x, bounds[0] + half[0]), bounds[2] - half[0])
        y = min(max(y, bounds[1] + half[1]), bounds[3] - half[1])
        self.anchor = anchor
        self.center = (x, y)
        self.box = (x - half[0] - GAP, y - half[1] - GAP, x + half[0] + GAP, y + half[1] + GAP)
        # The leader meets the text at the point nearest to the anchor.
        self.tip = (
            min(max(anchor[0], x - half[0]), x + half[0]),
            min(max(anchor[1], y - half[1]), y + half[1]),
        )
        self.length = math.hypot(self.tip[0] - anchor[0], self.tip[1] - anchor[1])
        self.cost = 0.0


def candidates(anchors, size, bounds, ink):
    """The places around the anchors, moved into the bounds, with their costs; cheapest first."""
    places = []
    for anchor, direction, distance in product(anchors, DIRECTIONS, DISTANCES):
        place = Candidate(anchor, size, direction, distance, bounds)
        place.cost = ink.in_box(place.box) + DISTANCE_COST * place.length
        if place.length > LEADER_FROM:
            # The ink at the anchor is that of the label's own line.
            start = [a + 11 / place.length * (t - a) for a, t in zip(anchor, place.tip)]
            place.cost += LEADER_COST * ink.along(start, place.tip)
        places.append(place)
    return sorted(places, key=lambda place: place.cost)


def overlap(a, b):
    """Whether two boxes meet."""
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def orientation(a, b, c):
    """Positive where a, b, c turn left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def cross(a, b, c, d):
    """Whether the segments ab and cd cross."""
    return (
        orientation(a, b, c) * orientation(a, b, d) < 0
        and orientation(c, d, a) * orientation(c, d, b) < 0
    )


def leader_hits(place, box):
    """Whether the leader of a place runs through a box."""
    left, bottom, right, top = box
    if left < place.anchor[0] < right and bottom < place.anchor[1] < top:
        return True
    diagonals = (((left, bottom), (right, top)), ((left, top), (right, bottom)))
    return any(cross(place.anchor, place.tip, *diagonal) for diagonal in diagonals)


def conflict(a, b):
    """The cost of two places together."""
    if overlap(a.box, b.box):
        return OVERLAP_COST
    cost = CROSSING_COST if cross(a.anchor, a.tip, b.anchor, b.tip) else 0.0
    return cost + CROSSING_COST * (leader_hits(a, b.box) + leader_hits(b, a.box))


def best_place(places, others):
    """The cheapest place beside those already taken; the places come sorted by their own cost."""
    best, lowest = None, math.inf
    for place in places:
        if place.cost >= lowest:
            break
        cost = place.cost + sum(conflict(place, other) for other in others)
        if cost < lowest:
            best, lowest = place, cost
    return best


def place_labels(anchors, sizes, bounds, ink):
    """A place for each label.

    anchors: for each label the points it may stand at. The labels are placed greedily, the most
    hindered first, and each is then moved in turn while that lowers the cost.
    """
    places = [candidates(a, s, bounds, ink) for a, s in zip(anchors, sizes)]
    order = sorted(range(len(places)), key=lambda i: -places[i][0].cost)
    chosen = {}
    for _ in range(PASSES):
        before = dict(chosen)
        for i in order:
            others = [place for j, place in chosen.items() if j != i]
            chosen[i] = best_place(places[i], others)
        if chosen == before:
            break
    return [chosen[i] for i in range(len(places))]


def line_label(axes, words, color, text_color, size=9, white=0, alpha=None, leader=None):
    """The label of a line, still at the origin of the axes, with a leader in the line's colour, on
    white of this opacity."""
    box = {"facecolor": "white", "alpha": white, "edgecolor": "none", "pad": 0.8}
    line = {"arrowstyle": "-", "color": color, "lw": 0.8, "shrinkA": 0}
    return axes.annotate(
        words,
        (0, 0),
        (0, 0),
        textcoords="offset points",
        size=size,
        alpha=alpha,
        color=text_color,
        ha="center",
        va="center",
        zorder=6,
        annotation_clip=False,
        bbox=box if white else None,
        arrowprops=line | (leader or {}),
    )


def move_labels(texts, anchors, ink, position_of):
    """Puts each label near one of its anchors in pixels, off the others and off the ink.
    `position_of` turns an anchor into a position in its axes. A label apart from its line has a
    leader."""
    # The extent of an annotation counts its leader in; that of its text is wanted here.
    sizes = [Text.get_window_extent(text).size for text in texts]
    for text, place in zip(texts, place_labels(anchors, sizes, ink.bounds, ink)):
        text.xy = position_of(place.anchor)
        offset = [(c - a) * 72 / DPI for c, a in zip(place.center, place.anchor)]
        text.set_position(offset)
        text.arrow_patch.set_visible(place.length > LEADER_FROM)


def ink_within(axes):
    """No ink yet, in all of the axes but their edges."""
    box = axes.bbox
    return Ink((box.x0 + 4, box.y0 + 4, box.x1 - 4, box.y1 - 4))


def label_lines(axes, lines, anchors_of, ink, **style):
    """Names each of the lines (words, colour, colour of the words, points), off the others and off
    the ink. `anchors_of` turns a line's pixels into the places that its name may be near."""
    texts, anchors = [], []
    for words, color, text_color, points in lines:
        pixels = [tuple(axes.transData.transform(point)) for point in points]
        for start, end in zip(pixels, pixels[1:]):
            ink.add_line(start, end, 2.0)
        anchors.append(anchors_of(pixels))
        texts.append(line_label(axes, words, color, text_color, **style))
    move_labels(texts, anchors, ink, axes.transData.inverted().transform)
