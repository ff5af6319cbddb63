#!/usr/bin/python3
"""What files simulate may replace by a motion, and what is left where the disk is full.

Call: check_replacing.py --bin FOLDER.
"""

import os
import resource
import signal

from motion_case import run_words, tried_place


def check_refused(place, words, *fragments):
    """One sentence with the fragments beside warnings, status 2, and no file that was not there."""
    before = sorted(os.listdir(place.folder))
    ended = place.run(words)
    lines = ended.stderr.strip().split("\n")
    said = "\n".join(line for line in lines if "warning: " not in line)
    assert ended.returncode == 2, (words, ended.returncode, said)
    assert said.startswith("simulate: ") and "\n" not in said, said
    for fragment in fragments:
        assert fragment in said, (fragment, said)
    assert sorted(os.listdir(place.folder)) == before, words


def check_replacing(place):
    """Own files are replaced, those of others only with --force, and what was read never."""
    for path, companion in (("r.vtkhdf", "r.xdmf"), ("r.pc2", "r.obj")):
        words = run_words("cloth", f"--motion {path}")
        for _ in range(2):
            ended = place.run(words)
            assert ended.returncode == 0, ended.stderr
        place.write(companion, "mine\n")
        check_refused(place, words, companion, "--force")
        assert place.run(words + " --force").returncode == 0
        for name in place.files("r."):
            os.remove(place.path(name))
        place.write(path, "mine\n")
        check_refused(place, words, path, "--force")
        os.remove(place.path(path))
    check_refused(
        place, run_words("meshed", "--force --motion left_out.pc2"), "left_out.obj", "was read"
    )


def check_full_disk(place):
    """Files that may not grow as far as they need: status 3, one sentence, no file."""
    for path, most in (("full.vtkhdf", 9000), ("full.vtkhdf", 300), ("full.pc2", 1000)):
        words = run_words("cloth", f"--motion {path}")
        ended = place.run(words, preexec_fn=lambda most=most: limit(most))
        said = ended.stderr.strip()
        assert ended.returncode == 3, (path, most, ended.returncode, said)
        assert said.startswith(f"simulate: {path.split('.')[0]}") and "\n" not in said, said
        assert "File too large" in said, said
        assert place.files("full") == [], place.files("full")


def limit(most):
    """Limits the size of files; as SIGXFSZ is ignored, writes beyond it fail as on a full disk."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))


def main():
    with tried_place(__doc__) as place:
        check_replacing(place)
        check_full_disk(place)


if __name__ == "__main__":
    main()
