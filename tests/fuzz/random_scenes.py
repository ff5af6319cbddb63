"""Random small scenes as files: those of the corpus with other numbers and names; whole or spoiled.

Which scene files are refused, and how, is tried by fuzz_scenes; here programs get them.
"""

import math
import re
from pathlib import Path

from hostile_values import EXTREMES, HOSTILE_NAMES, JUNK, PATHS_OF_NO_MESH, WORDS

CORPUS = {file.name: file.read_bytes() for file in Path(__file__).with_name("corpus").iterdir()}
SCENES = sorted(name for name in CORPUS if name.endswith(".toml"))


def quoted(text):
    """A TOML basic string."""
    escaped = "".join(
        f"\\u{ord(c):04X}" if ord(c) < 32 or ord(c) == 127 or c in '"\\' else c for c in text
    )
    return f'"{escaped}"'


def varied(random, text, extremes):
    """The text with some of its numbers (those with a point) multiplied or, with the chance `extremes`,
    replaced by any."""

    def another(number):
        if random.random() < extremes:
            return repr(random.choice(EXTREMES)).replace("+", "")
        if random.random() < 0.7:
            return number[0]
        return f"{float(number[0]) * math.exp(random.gauss(0, 1)):.6g}"

    return re.sub(r"-?\d+\.\d+", another, text)


def spoiled(random, data):
    """The bytes with one thing wrong: bits, lines, numbers, line ends, marks or the end."""
    at, lines = random.randrange(len(data) + 1), data.split(b"\n")
    line = random.randrange(len(lines))
    words = lines[line].split(b" ")
    words[random.randrange(len(words))] = random.choice(WORDS)
    return random.choice(
        [
            data[:at] + bytes([random.randrange(256)]) + data[at + 1 :],
            data[:at] + random.choice(JUNK) + data[at:],
            data[:at],
            data[:at] + data[at + random.randrange(1, 20) :],
            b"\n".join(lines[:line] + lines[line + 1 :]),
            b"\n".join(lines[:line] + [lines[line]] * 2 + lines[line + 1 :]),
            b"\n".join(lines[:line] + [b" ".join(words)] + lines[line + 1 :]),
            data.replace(b"\n", random.choice([b"\r", b"\r\n"])),
            b"\xef\xbb\xbf" + data,
        ]
    )


def random_scene(random):
    """Files of one scene, name to bytes; "scene.toml" is the one to give to --scene."""
    text, files = CORPUS[random.choice(SCENES)].decode(), {}
    text = re.sub(r"(?m)^until = .*\n", "", text)
    if mesh := re.search(r'file = "(.*)"', text):
        name = mesh[1]
        files[name] = CORPUS[name]
        paths = [name] * 12 + [f"./{name}", f"sub/../{name}"] * 3 + PATHS_OF_NO_MESH
        text = text.replace(mesh[0], f"file = {quoted(random.choice(paths))}")
    text = varied(random, text, random.choice([0, 0, 0, 0.01, 0.1]))
    for line, chance in [
        (f"until = {random.uniform(1e-3, 2e-2):.5f}\n", 1), ("stiff_above = 300\n", 0.2),
        ('start = "equilibrium"\n', 0.1),
        (f"name = {quoted(random.choice(HOSTILE_NAMES))}\n", 0.25),
    ]:  # fmt: skip
        if random.random() < chance:
            key = line.split("=")[0]
            text = line + re.sub(rf"(?m)^{key}=.*\n", "", text)
    files["scene.toml"] = text.encode()
    if random.random() < 0.25:
        for _ in range(random.choice([1, 1, 1, 2, 5])):
            name = random.choice(sorted(files))
            files[name] = spoiled(random, files[name])
    return files
