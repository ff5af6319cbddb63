"""Random small scenes as files: generators with parameters, networks, meshes; whole or spoiled."""

import math

from hostile_values import EXTREMES, HOSTILE_NAMES

GENERATORS = {
    "oscillator": ["mass", "stiffness", "position", "velocity"],
    "orbit": ["mass", "stiffness", "rest_length", "radius", "speed"],
    "pair": ["mass_1", "mass_2", "stiffness", "rest_length", "stretch", "spin"],
    "pendulum": ["mass", "stiffness", "rest_length", "length", "angle", "speed", "gravity"],
    "chain": ["length", "mass", "stiffness", "gravity"],
    "cloth": [
        "side",
        "mass",
        "structural_stiffness",
        "shear_stiffness",
        "bending_stiffness",
        "gravity",
    ],
    "framed_cloth": ["side", "mass", "structural_stiffness", "frame_stiffness", "gravity"],
    "lattice": ["length", "mass", "stiffness", "gravity"],
    "fpu": ["frequency"],
    "strut": ["length", "mass", "stiffness", "compression", "bend"],
}
COUNTS = {
    "chain": [("nodes", 2, 9)],
    "cloth": [("nodes", 2, 4)],
    "framed_cloth": [("nodes", 3, 4)],
    "lattice": [("nodes_x", 2, 3), ("nodes_y", 2, 2), ("nodes_z", 2, 2)],
    "fpu": [("stiff_springs", 1, 3)],
    "strut": [("nodes", 3, 7)],
}


def quoted(text):
    """A TOML basic string."""
    escaped = "".join(
        f"\\u{ord(c):04X}" if ord(c) < 32 or ord(c) == 127 or c in '"\\' else c for c in text
    )
    return f'"{escaped}"'


def number(random, low, high, extremes):
    """A number between, logarithmically, or with the chance `extremes` one that is anything."""
    if random.random() < extremes:
        return repr(random.choice(EXTREMES)).replace("+", "")
    return f"{math.exp(random.uniform(math.log(low), math.log(high))):.6g}"


def _generator(random, extremes):
    kind = random.choice(sorted(GENERATORS))
    lines = ["[generator]", f'kind = "{kind}"', f"until = {number(random, 1e-3, 2e-2, extremes)}"]
    lines += [f"{name} = {random.randint(low, high)}" for name, low, high in COUNTS.get(kind, [])]
    for name in GENERATORS[kind]:
        if random.random() < 0.2:
            lines.append(f"{name} = {number(random, 0.5, 50, extremes)}")
    return lines


def _network(random, extremes):
    d, n = random.randint(1, 3), random.randint(1, 9)
    where = lambda: "[" + ", ".join(f"{random.uniform(-1, 1):.3f}" for _ in range(d)) + "]"
    lines = [f"dimension = {d}", f"until = {number(random, 1e-3, 2e-2, extremes)}"]
    if random.random() < 0.6:
        lines.append(f"gravity = {where()}")
    places = []
    for i in range(n):
        places.append(random.choice(places) if places and random.random() < 0.03 else where())
        mass = 0 if random.random() < 0.04 else number(random, 0.05, 5, extremes)
        lines += ["[[nodes]]", f"position = {places[-1]}", f"mass = {mass}"]
        if i == 0 and random.random() < 0.7 or random.random() < 0.1:
            lines.append("pinned = true")
        if random.random() < 0.3:
            lines.append(f"velocity = {where()}")
    ends = [(i, random.randrange(i)) for i in range(1, n) if random.random() < 0.9]
    ends += [(random.randrange(n), random.randrange(n)) for _ in range(random.randint(0, n))]
    for i, j in ends:
        if i == j and random.random() < 0.95:
            continue
        lines += [
            "[[springs]]",
            f"nodes = [{i}, {j}]",
            f"stiffness = {number(random, 10, 1e4, extremes)}",
        ]
        if random.random() < 0.4:
            lines.append(f"rest_length = {number(random, 0.1, 2, extremes)}")
        if random.random() < 0.1:
            lines.append(f"quartic = {number(random, 1, 1e3, extremes)}")
    return lines


def _grid(random):
    n, m = random.randint(2, 3), random.randint(2, 3)
    points = [(i, j, round(random.uniform(-0.1, 0.1), 3)) for i in range(n) for j in range(m)]
    if random.random() < 0.2:
        points.append((9, 9, 9))  # no element uses it
    cells = [
        (i * m + j, i * m + j + 1, (i + 1) * m + j) for i in range(n - 1) for j in range(m - 1)
    ]
    cells += [(b, c + 1, c) for a, b, c in cells]
    return points, cells


def _mesh_text(kind, points, cells):
    rows = lambda items, lead, tail, base: "".join(
        lead(k) + " ".join(str(x + base) for x in item) + tail for k, item in enumerate(items)
    )
    if kind == "obj":
        return rows(points, lambda k: "v ", "\n", 0) + rows(cells, lambda k: "f ", "\n", 1)
    if kind == "mesh":
        return (
            f"MeshVersionFormatted 1\nDimension 3\nVertices\n{len(points)}\n"
            + rows(points, lambda k: "", " 0\n", 0)
            + f"Triangles\n{len(cells)}\n"
            + rows(cells, lambda k: "", " 0\n", 1)
            + "End\n"
        )
    return (
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n"
        + rows(points, lambda k: f"{k + 1} ", "\n", 0)
        + f"$EndNodes\n$Elements\n{len(cells)}\n"
        + rows(cells, lambda k: f"{k + 1} 2 2 0 1 ", "\n", 1)
        + "$EndElements\n"
    )


def _mesh(random, extremes):
    kind = random.choice(["obj", "mesh", "msh"])
    file = random.choice(
        (["body." + kind] * 6 + ["./body." + kind, "sub/../body." + kind]) * 3
        + [
            "fifo.obj",
            "folder.mesh",
            "none.obj",
            "locked.obj",
            "zero.obj",
            "zero.msh",
            "scene.toml",
            "loop.mesh",
        ]
    )
    lines = [
        "gravity = [0.0, 0.0, -9.81]",
        f"until = {number(random, 1e-3, 2e-2, extremes)}",
        "[mesh]",
        f"file = {quoted(file)}",
        f"stiffness = {number(random, 10, 1e4, extremes)}",
        f"{random.choice(['node_mass', 'total_mass'])} = {number(random, 0.1, 5, extremes)}",
    ]
    for key in ["scale", "bending_stiffness"]:
        if random.random() < 0.3:
            lines.append(f"{key} = {number(random, 0.1, 10, extremes)}")
    if random.random() < 0.7:
        lines += ["[[mesh.pin]]", "min = [-0.1, -0.1, -9]", "max = [0.5, 0.5, 9]"]
    return lines, {"body." + kind: _mesh_text(kind, *_grid(random)).encode()}


def spoiled(random, data):
    """The bytes with one thing wrong: bits, lines, numbers, line ends, marks or the end."""
    at = random.randrange(len(data) + 1)
    lines = data.split(b"\n")
    line = random.randrange(len(lines))
    junk = [
        b"\0",
        b"\r",
        b"\x1b[2J",
        b"\xff",
        b"\xc3",
        b"\xef\xbb\xbf",
        b'"',
        b"[",
        b"=",
        b"-",
        b"e",
        b"9" * 400,
    ]
    match random.randrange(9):
        case 0:
            return data[:at] + bytes([random.randrange(256)]) + data[at + 1 :]
        case 1:
            return data[:at] + random.choice(junk) + data[at:]
        case 2:
            return data[:at]
        case 3:
            return b"\n".join(lines[:line] + lines[line + 1 :])
        case 4:
            return b"\n".join(lines[:line] + [lines[line]] * 2 + lines[line + 1 :])
        case 5:
            return data.replace(b"\n", random.choice([b"\r", b"\r\n"]))
        case 6:
            return b"\xef\xbb\xbf" + data
        case 7:
            return data[:at] + data[at + random.randrange(1, 20) :]
    words = lines[line].split(b" ")
    words[random.randrange(len(words))] = random.choice(
        [
            b"0",
            b"-1",
            b"1e300",
            b"1e400",
            b"nan",
            b"inf",
            b"99999999999",
            b"1e-320",
            b"x",
            b"true",
            b"{}",
        ]
    )
    return b"\n".join(lines[:line] + [b" ".join(words)] + lines[line + 1 :])


def random_scene(random):
    """Files of one scene, name to bytes; "scene.toml" is the one to give to --scene."""
    extremes = random.choice([0, 0, 0, 0.01, 0.1])
    kind, files = random.random(), {}
    if kind < 0.4:
        lines = _generator(random, extremes)
    elif kind < 0.7:
        lines = _network(random, extremes)
    else:
        lines, files = _mesh(random, extremes)
    for key, value, chance in [("stiff_above", "300", 0.2), ("start", '"equilibrium"', 0.1)]:
        if random.random() < chance:
            lines.insert(0, f"{key} = {value}")
    if random.random() < 0.25:
        lines.insert(0, f"name = {quoted(random.choice(HOSTILE_NAMES))}")
    files["scene.toml"] = ("\n".join(lines) + "\n").encode()
    if random.random() < 0.25:
        for _ in range(random.choice([1, 1, 1, 2, 5])):
            name = random.choice(sorted(files))
            files[name] = spoiled(random, files[name])
    return files
