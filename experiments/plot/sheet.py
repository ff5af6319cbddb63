"""A figure laid out in inches from its upper left corner, and its writing to files."""

import os
import sys
from pathlib import Path

import matplotlib.pyplot as plt

from measurements import status_of
from style import FAINT, GRID, INK, use_style

DPI = 160


class Sheet:
    """A figure whose parts are placed in inches, measured to the right and downwards."""

    def __init__(self, width, height):
        self.width = width
        self.height = height
        self.figure = plt.figure(figsize=(width, height), dpi=DPI, facecolor="white")

    def axes(self, left, top, width, height):
        """New axes in a rectangle."""
        bottom = self.height - top - height
        return self.figure.add_axes(
            (
                left / self.width,
                bottom / self.height,
                width / self.width,
                height / self.height,
            )
        )

    def text(self, left, top, content, **style):
        """A text at a point."""
        return self.figure.text(left / self.width, 1 - top / self.height, content, **style)

    def text_width(self, text):
        """The width of a drawn text in inches."""
        return text.get_window_extent(self.figure.canvas.get_renderer()).width / DPI

    def fitting(self, left, top, choices, right, **style):
        """Writes at a point the first of the texts that ends left of `right`, else the last."""
        text = self.text(left, top, "", **style)
        for choice in choices:
            text.set_text(choice)
            if left + self.text_width(text) < right:
                break

    def wrapped(self, words, room, **style):
        """The words with commas between them, in as many lines of that width as they need."""
        return self.filled([*(f"{word}," for word in words[:-1]), *words[-1:]], room, **style)

    def filled(self, words, room, **style):
        """The words in as many lines of that width as they need."""
        text = self.text(0, 0, "", **style)
        lines = [""]
        for word in words:
            text.set_text(f"{lines[-1]} {word}".strip())
            if lines[-1] and self.text_width(text) > room:
                lines.append("")
            lines[-1] = f"{lines[-1]} {word}".strip()
        text.remove()
        return lines

    def rule(self, top):
        """A thin line over the whole width."""
        height = 1 - top / self.height
        line = plt.Line2D((0.015, 0.985), (height, height), color=GRID, linewidth=1.0)
        self.figure.add_artist(line)

    def head(self, left, *lines):
        """What stands above all: the title and lines below it, each (top, size, words)."""
        for number, (top, size, words) in enumerate(lines):
            style = {"color": FAINT} if number else {"color": INK, "weight": "bold"}
            self.text(left, top, words, size=size, va="center", **style)

    def save_as(self, folder, name):
        """Writes the figure into a folder, in both formats."""
        for extension in ("png", "svg"):
            self.save(os.path.join(folder, f"{name}.{extension}"))

    def save(self, path):
        """Writes the figure to path, whole or not at all; the extension gives the format."""
        extension = os.path.splitext(path)[1]
        temporary = f"{path}.tmp{extension}"
        # Nothing that changes from one run to the next goes into the file.
        metadata = {"Date": None} if extension == ".svg" else {"Software": None}
        try:
            self.figure.savefig(temporary, dpi=DPI, metadata=metadata)
            os.replace(temporary, path)
        finally:
            if os.path.exists(temporary):
                os.remove(temporary)


def main(draw):
    """The call of a script that draws what lies in a folder: draw(folder) of the one that the command
    line names. Ends the process, with status 2 where a file cannot be read."""
    if len(sys.argv) == 2:
        use_style()
        sys.exit(status_of(draw, Path(sys.argv[1])))
    print(f"Usage: {os.path.basename(sys.argv[0])} DIR", file=sys.stderr)
    sys.exit(2)
