"""The band over a work-precision chart that names the fastest method at each accuracy."""

import math

from matplotlib.patches import Rectangle

from style import FRONT

FONT_SIZE = 9.5
MARKER_ROOM = 0.2


def stretches(front):
    """The stretches of accuracy with one fastest method, as (method, low, high).

    An accuracy stands for the half decades on both its sides.
    """
    half = math.sqrt(10.0)
    found = []
    for point in front:
        low, high = point.accuracy / half, point.accuracy * half
        if found and found[-1][0] == point.method and found[-1][1] < 1.01 * high:
            found[-1] = (point.method, low, found[-1][2])
        else:
            found.append((point.method, low, high))
    return found


def draw_stretch(sheet, axes, left, right, method, look):
    """One stretch, from left to right in inches: the method's marker and, where it fits, its
    name."""
    axes.add_patch(Rectangle((left, 0), right - left, 1, color=look.color, alpha=0.16, linewidth=0))
    for edge in (left, right):
        axes.axvline(edge, color="white", linewidth=2)
    middle = (left + right) / 2
    name = axes.text(middle, 0.5, method, size=FONT_SIZE, color=look.text_color, va="center")
    content = sheet.text_width(name) + MARKER_ROOM
    if content + 0.1 < right - left:
        name.set_x(middle - content / 2 + MARKER_ROOM)
        middle += MARKER_ROOM / 2 - content / 2
    else:
        name.remove()
    axes.plot([middle], [0.5], linestyle="", **look.marker_style())


def draw_band(sheet, rectangle, front, error_range, certified, looks):
    """The band in a rectangle (left, top, width, height), over the same errors as the chart; there
    is no fastest method below the certified floor."""
    left, top, width, height = rectangle
    axes = sheet.axes(*rectangle)
    axes.set_xlim(0, width)
    axes.set_ylim(0, 1)
    axes.set_axis_off()
    lowest, highest = error_range

    def inches(error):
        share = math.log(max(error, certified or 0.0) / lowest) / math.log(highest / lowest)
        return width * min(max(share, 0.0), 1.0)

    for method, low, high in stretches(front):
        if inches(low) < inches(high):
            draw_stretch(sheet, axes, inches(low), inches(high), method, looks[method])
    sheet.text(
        left - 0.14,
        top + height / 2,
        "fastest",
        size=10,
        ha="right",
        va="center",
        bbox={"facecolor": FRONT, "alpha": 0.75, "edgecolor": "none", "pad": 2},
    )
