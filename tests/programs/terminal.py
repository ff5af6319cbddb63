"""Programs in a terminal of their own, and what is then to be seen on its screen."""

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time

# What may move the cursor, and text. Anything else is no part of a progress.
_PIECES = re.compile(r"\r\n|\r|\n|\x1b\[K|\x1b|[^\r\n\x1b]+")


class Screen:
    """A screen of so many columns and no end of rows. Its faults: a line of progress (which a
    carriage return begins) that is wrapped, and bytes that it does not know.
    """

    def __init__(self, columns):
        self.columns, self.rows, self.column = columns, [""], 0
        self.faults, self.seen, self._is_progress = [], set(), False

    def show(self, text):
        for piece in _PIECES.findall(text):
            if piece in ("\n", "\r\n"):
                self.rows.append("")
                self.column, self._is_progress = 0, False
            elif piece == "\r":
                self.column, self._is_progress = 0, True
            elif piece == "\x1b[K":
                self.rows[-1] = self.rows[-1][: self.column]
                self.seen.add(self.rows[-1])
                self._is_progress = self.column > 0
            elif piece == "\x1b":
                self.faults.append("an escape sequence")
            else:
                row = self.rows[-1]
                self.rows[-1] = row[: self.column] + piece + row[self.column + len(piece) :]
                self.column += len(piece)
                if self._is_progress and self.column >= self.columns:
                    self.faults.append("wrapped: " + piece)

    @property
    def lines(self):
        """What is on it at last."""
        return [row for row in self.rows if row]


class Terminal:
    """A process whose stderr, and stdin, are a terminal, and stdout a pipe or the terminal too."""

    def __init__(self, argv, columns=40, shows_stdout=False, **variables):
        self.screen = Screen(columns)
        self._master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        environment = dict(os.environ, TERM="xterm") | variables

        def own_terminal():
            os.setsid()
            fcntl.ioctl(0, termios.TIOCSCTTY, 0)

        self._process = subprocess.Popen(
            argv,
            stdin=slave,
            stdout=slave if shows_stdout else subprocess.DEVNULL,
            stderr=slave,
            env=environment,
            preexec_fn=own_terminal,
        )
        os.close(slave)

    def read(self):
        """Shows what comes next; False where nothing does any more."""
        ready, _, _ = select.select([self._master], [], [], 0.2)
        if not ready:
            return self._process.poll() is None
        try:
            data = os.read(self._master, 65536)
        except OSError:  # how Linux says that the other side is closed
            return False
        self.screen.show(data.decode())
        return bool(data)

    def wait_for(self, fragment, limit=120):
        """Until the line on the screen holds that; raises TimeoutError where it never does."""
        end = time.monotonic() + limit
        while not any(fragment in line for line in self.screen.seen):
            if not self.read() or time.monotonic() > end:
                raise TimeoutError(f"{fragment!r} is not among {sorted(self.screen.seen)[:20]}")

    def press(self, keys):
        os.write(self._master, keys)

    def end(self):
        """The exit status, once all is shown; a signal counts as 128 + its number."""
        while self.read():
            pass
        status = self._process.wait()
        os.close(self._master)
        return status if status >= 0 else 128 - status
