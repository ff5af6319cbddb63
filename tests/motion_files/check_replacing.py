"""Files that simulate may replace by a motion, and what is left where the disk is full."""

import glob
import os
import resource

from motion_case import Motions, run_words
from programs import run, write


class Replacing(Motions):
    def test_own_files_are_replaced_those_of_others_by_force_and_what_was_read_never(self):
        for path, companion in (("r.vtkhdf", "r.xdmf"), ("r.pc2", "r.obj")):
            line = "simulate " + run_words("cloth", f"--motion {path}")
            for _ in range(2):
                self.done(line)
            write(companion, "mine\n")
            self.refused(line, companion, "--force")
            self.done(line + " --force")
            for name in glob.glob("r.*"):
                os.remove(name)
            write(path, "mine\n")
            self.refused(line, path, "--force")
            os.remove(path)
        ended = run("simulate " + run_words("meshed", "--force --motion left_out.pc2"))
        warning, ended.stderr = ended.stderr.split("\n", 1)
        self.assertIn("no edge uses", warning)
        self.complains(ended, 2, "left_out.obj", "was read")
        self.assertEqual(glob.glob("left_out.*"), ["left_out.obj"])

    def test_where_files_may_not_grow_as_they_need_none_is_left(self):
        for path, most in (("full.vtkhdf", 9000), ("full.vtkhdf", 300), ("full.pc2", 1000)):
            # As SIGXFSZ stays ignored, writes beyond the limit fail as on a full disk.
            ended = run(
                "simulate " + run_words("cloth", f"--motion {path}"), restore_signals=False,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)),
            )  # fmt: skip
            # Clang's OpenMP warns that it cannot write a file of its own.
            lines = ended.stderr.splitlines(keepends=True)
            ended.stderr = "".join(line for line in lines if not line.startswith("OMP: "))
            self.complains(ended, 3, "simulate: full", "File too large")
            self.assertEqual(glob.glob("full*"), [])
