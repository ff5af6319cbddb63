"""A figure laid out in inches from its upper left corner, and its writing to files."""

import os

import matplotlib.pyplot as plt

from style import GRID

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
