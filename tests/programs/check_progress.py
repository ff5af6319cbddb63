"""The line that says how far a study is, in a terminal and elsewhere."""

import fcntl
import os
import pty
import re
import struct
import subprocess
import termios

from programs import Programs, words_of
from studies import STUDIES, write_scenes

COLUMNS = 60
PROGRESS = r"\r([^\r\n\x1b]*)\x1b\[K"
LONG = "--scene steady.toml --repeats 1000 --point-limit 1000 --until 0.02"


def in_terminal(line, interrupt_at="", term="xterm"):
    """The exit status, what stays and the lines of progress of a command in a terminal of its own.
    Such a line stands between a carriage return and ESC [K; an empty one wipes it at the end. The
    command is interrupted by Ctrl-C once it has written the fragment."""
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, COLUMNS, 0, 0))

    def own_terminal():
        os.setsid()
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)

    process = subprocess.Popen(
        words_of(line), stdin=slave, stdout=subprocess.DEVNULL, stderr=slave,
        env=os.environ | {"TERM": term}, preexec_fn=own_terminal,
    )  # fmt: skip
    os.close(slave)
    written = b""
    while True:
        try:
            data = os.read(master, 65536)
        except OSError:  # how Linux says that the other side is closed
            break
        written += data
        if interrupt_at and interrupt_at.encode() in written:
            os.write(master, b"\x03")
            interrupt_at = ""
    os.close(master)
    text = written.decode().replace("^C", "")
    seen = re.findall(PROGRESS, text)
    is_wiped = seen[-1:] in ([], [""])
    return process.wait(), re.sub(PROGRESS, "", text) if is_wiped else text, seen


class Progress(Programs):
    def setUp(self):
        super().setUp()
        write_scenes(".")

    def test_every_study_has_a_line_that_fits_and_is_wiped_at_the_end(self):
        for program in "convergence energy_drift exchange stability_map work_precision".split():
            with self.subTest(program):
                line = f"{program} {STUDIES[program]} --out {program}"
                status, left, seen = in_terminal(line)
                self.assertEqual((status, left), (0, ""))
                self.assertTrue(any(re.search(r"\d:\d\d", line) for line in seen), seen)
                self.assertLess(max(map(len, seen)), COLUMNS)

    def test_an_interruption_wipes_it_and_what_was_measured_counts(self):
        study = f"work_precision {LONG} --out out"
        cloth = "simulate --scene cloth --method verlet --step-size 1e-5 --until 1e5"
        for line, fragment, words in (
            (study, "1/", "--resume"), (study + " --resume", "/", "kept from before"),
            (cloth, "t = ", ""),
        ):  # fmt: skip
            status, said, seen = in_terminal(line, fragment)
            self.assertEqual(status, 130)
            self.assertRegex(said, f"(?s)^{line.split()[0]}: .*interrupted by SIGINT")
            self.assertIn(words, said)
            self.assertTrue(seen)

    def test_a_pipe_and_a_dumb_terminal_get_none_of_it(self):
        line = f"work_precision {STUDIES['work_precision']} --out out"
        self.assertEqual(in_terminal(line, term="dumb")[0::2], (0, []))
        self.assertEqual(in_terminal(line + " --progress none"), (0, "", []))
        self.assertNotRegex(self.done(line).stderr, "[\r\x1b]")
