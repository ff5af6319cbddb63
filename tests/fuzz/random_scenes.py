"""Random small scenes as files: samples whose numbers and names are changed; whole or spoiled.

Which scene files are refused, and how, is tried by fuzz_scenes; here programs get them.
"""

import math
import re

from hostile_values import EXTREMES, HOSTILE_NAMES

GENERATED = [
    'kind = "oscillator"',
    'kind = "orbit"\nrest_length = 0.5\nspeed = 2.5',
    'kind = "pair"\nmass_1 = 2.5\nspin = 1.5',
    'kind = "pendulum"\nstiffness = 40.5\nangle = 1.5\ngravity = 9.5',
    'kind = "chain"\nnodes = 5\nlength = 1.5\nstiffness = 30.5',
    'kind = "cloth"\nnodes = 4\nside = 1.5\nbending_stiffness = 3.5',
    'kind = "framed_cloth"\nnodes = 3\nframe_stiffness = 3000.5',
    'kind = "lattice"\nnodes_x = 3\nnodes_y = 2\nnodes_z = 2\nmass = 2.5',
    'kind = "fpu"\nstiff_springs = 2\nfrequency = 20.5',
    'kind = "strut"\nnodes = 5\ncompression = 0.9\nbend = 0.01',
]
NETWORKS = [
    """dimension = 1
nodes = [{position = [0.0], pinned = true}, {position = [1.5], mass = 0.5, velocity = [0.1]}]
springs = [{nodes = [0, 1], stiffness = 100.5, rest_length = 1.2, quartic = 50.5}]
""",
    """dimension = 2
gravity = [0.1, -9.5]
nodes = [{position = [0.0, 0.0], pinned = true}, {position = [0.5, 0.1], mass = 0.1},
         {position = [1.1, 0.0], mass = 0.3}, {position = [1.1, 0.0], mass = 0}, {position = [2.5, 1.5]}]
springs = [{nodes = [0, 1], stiffness = 1000.5}, {nodes = [1, 2], stiffness = 90.5},
           {nodes = [1, 2], stiffness = 10.5}, {nodes = [2, 3], stiffness = 40.5}]
""",
    """dimension = 3
nodes = [{position = [0.1, 0.2, 0.3], velocity = [0.5, -0.1, 0.2], mass = 1.5},
         {position = [1.1, 0.2, 0.1], mass = 0.5}, {position = [0.3, 1.2, 0.5], mass = 2.5}]
springs = [{nodes = [0, 1], stiffness = 500.5}, {nodes = [1, 2], stiffness = 50.5, rest_length = 0.7}]
""",
]
MESHES = {
    "body.obj": b"v 0 0 0\nv 1 0 0.1\nv 0 1 0\nv 1 1 0.2\nv 9 9 9\nf 1 2 3\nf 2 4 3\n",
    "body.mesh": b"MeshVersionFormatted 1\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0.1 0\n0 1 0 0\n"
    b"1 1 0.2 0\nTriangles\n2\n1 2 3 1\n2 4 3 1\nEnd\n",
    "body.msh": b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0.1\n3 0 1 0\n"
    b"4 1 1 0.2\n$EndNodes\n$Elements\n2\n1 2 2 0 1 1 2 3\n2 2 2 0 1 2 4 3\n$EndElements\n",
}
PATHS_OF_NO_MESH = [
    "fifo.obj", "folder.mesh", "none.obj", "locked.obj", "zero.obj", "zero.msh", "scene.toml", "loop.mesh",
]  # fmt: skip
JUNK = [
    b"\0", b"\r", b"\x1b[2J", b"\xff", b"\xc3", b"\xef\xbb\xbf", b'"', b"[", b"=", b"-", b"e", b"9" * 400,
]  # fmt: skip
WORDS = b"0 -1 1e300 1e400 nan inf 99999999999 1e-320 x true {}".split()


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
    extremes = random.choice([0, 0, 0, 0.01, 0.1])
    until, kind, files = f"until = {random.uniform(1e-3, 2e-2):.5f}\n", random.random(), {}
    if kind < 0.4:
        text = f"[generator]\n{random.choice(GENERATED)}\n{until}"
    elif kind < 0.7:
        text = until + random.choice(NETWORKS)
    else:
        name = random.choice(sorted(MESHES))
        paths = [name] * 12 + [f"./{name}", f"sub/../{name}"] * 3 + PATHS_OF_NO_MESH
        files[name] = MESHES[name]
        text = (
            f"gravity = [0.0, 0.0, -9.81]\n{until}[mesh]\nfile = {quoted(random.choice(paths))}\n"
            f"stiffness = 1000.5\n{random.choice(['node_mass', 'total_mass'])} = 0.5\n"
            "[[mesh.pin]]\nmin = [-0.1, -0.1, -9.0]\nmax = [0.5, 0.5, 9.0]\n"
        )
    text = varied(random, text, extremes)
    for line, chance in [
        ("stiff_above = 300\n", 0.2),
        ('start = "equilibrium"\n', 0.1),
        (f"name = {quoted(random.choice(HOSTILE_NAMES))}\n", 0.25),
    ]:
        if random.random() < chance:
            text = line + text
    files["scene.toml"] = text.encode()
    if random.random() < 0.25:
        for _ in range(random.choice([1, 1, 1, 2, 5])):
            name = random.choice(sorted(files))
            files[name] = spoiled(random, files[name])
    return files
