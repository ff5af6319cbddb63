"""The name of a scene, as large as the room at the left of its row lets it be."""

from names import shown

ONE_LINE_SIZES, TWO_LINES_SIZES = (10.5, 10, 9.5, 9, 8.5), (8.5, 8, 7.5)
STYLE = {"weight": "bold", "va": "center", "linespacing": 1.0}
# A name may be broken after these.
ENDS = "_-., =+"


def in_two(name):
    """A name as two lines, broken at the place nearest to its middle that is good, else there."""
    middle = len(name) / 2
    places = [i + 1 for i, letter in enumerate(name[:-1]) if letter in ENDS]
    # A line that is much the longer one is of no use.
    good = [place for place in places if abs(place - middle) <= len(name) / 6]
    place = min(good, key=lambda place: abs(place - middle)) if good else round(middle)
    return name[:place].rstrip(" "), name[place:].lstrip(" ")


def cut(name, length):
    """A name of at most so many letters; those left out are of its middle."""
    if len(name) <= length:
        return name
    tail = (length - 1) // 2
    return f"{name[: length - 1 - tail]}…{name[len(name) - tail :]}"


def attempts(name):
    """The ways to write a name, the best first: (size, lines)."""
    for size in ONE_LINE_SIZES:
        yield size, (name,)
    for size in TWO_LINES_SIZES:
        yield size, in_two(name)
    for length in range(len(name) - 1, 1, -1):
        yield TWO_LINES_SIZES[-1], in_two(cut(name, length))


def draw_title(sheet, left, height, room, name):
    """Draws the name of a scene in one line or two, centred at a height; returns how many lines."""
    text = sheet.text(left, height, "", **STYLE)
    lines = ()
    for size, lines in attempts(name):
        text.set_text("\n".join(map(shown, lines)))
        text.set_size(size)
        if sheet.text_width(text) <= room:
            break
    return len(lines)
