"""The PNG pictures of other studies in the same folder, as they stand in a page."""

import base64
import io
import os

from PIL import Image

# Charts are lines on white: so many colours keep them as they look, in a quarter of the bytes.
COLORS = 128
SMALL = 150_000  # bytes of a file that is taken as it is
MOST = 2_500_000  # bytes of all pictures in a page
CHART = "chart.png"
# The others that studies may leave: the title and what it shows in words.
PICTURES = {
    "stability_map.png": (
        "Where each method is stable",
        "outcome of whole runs by method and step size",
    ),
    "stability_modes.png": (
        "Which natural modes grow",
        "growth of the natural modes by method and step size",
    ),
    "modes.png": ("The lowest natural modes", "shapes of the scene's lowest natural modes"),
    "energy_drift.png": (
        "Where the energy goes over a long run",
        "energy error over time, by method",
    ),
    "exchange.png": (
        "The energy that stiff springs exchange",
        "energies of stiff springs over time, by method and step size",
    ),
}


def reduced(data):
    """The PNG's bytes with fewer colours, or the same where that does not make it smaller. Raises
    OSError where they are no picture."""
    with Image.open(io.BytesIO(data)) as image:
        image.load()
        if len(data) <= SMALL:
            return data
        flat = Image.alpha_composite(Image.new("RGBA", image.size, "white"), image.convert("RGBA"))
        few = flat.convert("RGB").quantize(COLORS, Image.Quantize.FASTOCTREE, dither=0)
        buffer = io.BytesIO()
        few.save(buffer, "PNG", optimize=True)
        return min(data, buffer.getvalue(), key=len)


def data_uri(path):
    """The picture in a file as a data URI. Raises OSError where it is no picture."""
    with open(path, "rb") as file:
        data = reduced(file.read())
    return "data:image/png;base64," + base64.b64encode(data).decode("ascii")


def pictures_part(directory):
    """The page's `pictures`, the chart's data URI or None, and sentences on pictures left out."""
    uris, notes = {}, []
    for name in (CHART, *PICTURES):
        path = os.path.join(directory, name)
        if not os.path.exists(path):
            continue
        try:
            uri = data_uri(path)
        # Pillow raises these for a file that is no whole picture.
        except (OSError, SyntaxError, ValueError, Image.DecompressionBombError):
            notes.append(f"{name} is no picture that can be read.")
            continue
        if sum(map(len, uris.values())) + len(uri) > MOST:
            notes.append(f"{name} is too large for this page; it lies in the folder.")
            continue
        uris[name] = uri
    chart = uris.pop(CHART, None)
    entries = [dict(zip(("title", "alt"), PICTURES[name])) | {"src": uris[name]} for name in uris]
    return entries, chart, notes
