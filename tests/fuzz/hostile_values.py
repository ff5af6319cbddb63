"""Values that are likely to be taken amiss: numbers, texts, names of scenes, paths in a sandbox."""

import math

# fmt: off
# For options that take a number or several.
EDGE_NUMBERS = [
    "0", "-0", "-1", "1e300", "1e-300", "5e-324", "1.7976931348623157e308", "1e400", "-1e300",
    "nan", "inf", "-inf", "", " ", "1e", "0x10", "1.5.2", "99999999999999999999", "2147483647",
    "2147483648", "-2147483649", "18446744073709551616", "1e9", "1e-9", "1e-16", "true", "½",
    "+1", "--1", "1_000", "0.1", "1", "2", "3", "1000", "1 2", "1,", ",1", "1,,2", "0,0", "1,nan",
]
# Values for any option.
EDGE_TEXTS = [
    "", " ", ".", "..", "/", "$HOME", "$(touch x)", "`x`", '"', "'", "a\nb", "a\rb",
    "\x1b[31mred", "\x07", "\x9b31m", "ünïcödé", "漢字", "\udcff\udcfe", "x" * 300, "x" * 5000,
    "x/x/" * 750, "%s%n", "{}", "\\", ",", ",,", "a,b", "two words", "-", "-h", "--help", "*",
    "~", "a=b", "@1", "chain@nan",
]
# Files of a sandbox, and some that it does not have.
PATHS = [
    "scene.toml", "./scene.toml", "sub/../scene.toml", "end.json", "end.csv", "notes.txt",
    "body.obj", "mine", "mine/points.csv", "results", "folder", "folder/", "fifo", "locked.toml",
    "locked", "locked/x.csv", "link.toml", "loop", "dangling", "dangling/x.csv", "zero", "full",
    "empty.toml", "$x.toml", "-dash.toml", "none/x.csv", "none.toml", "scene.toml/x.csv",
    "new.csv", "new", "scene", "scene.csv", "x" * 260, "mine/end.csv",
    "new.vtkhdf", "new.pc2", "body.pc2", "a:b.vtkhdf", "none/x.pc2", "locked/x.vtkhdf", ".vtkhdf", ".", "..", "",
]
# Names of scenes.
HOSTILE_NAMES = [
    "", " ", ".", "..", "...", "../up", "a/b", "$\\frac{1}$", "$HOME", "`id`", "a\nb", "a\tb",
    "\x1b[31mred", "\x7f", "\x9b31m", 'bridge "x"', "Brücke", "漢字", "x" * 3000, "%s%n", "{}",
    "{0}", "a,b", "-h", "con", "\u202egnp", "=1+1",
]
# Numbers in scene files.
EXTREMES = [
    0.0, -0.0, -1.0, 1e+300, -1e+300, 1e-300, 5e-324, 1.7976931348623157e+308, 1e+200, 1e-200,
    1e+16, math.nan, math.inf, -math.inf,
]
# Meshes of scene files.
PATHS_OF_NO_MESH = [
    "fifo.obj", "folder.mesh", "none.obj", "locked.obj", "zero.obj", "zero.msh", "scene.toml", "loop.mesh",
]
# Bytes and words that are put into files.
JUNK = [
    b"\0", b"\r", b"\x1b[2J", b"\xff", b"\xc3", b"\xef\xbb\xbf", b'"', b"[", b"=", b"-", b"e", b"9" * 400,
]
WORDS = b"0 -1 1e300 1e400 nan inf 99999999999 1e-320 x true {}".split()
