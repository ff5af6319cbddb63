#!/usr/bin/python3
"""Whether the campaigns see what they look for, on programs that are made to be wrong."""

import os
import random
import tempfile
import unittest

import fuzz_kills
import studies
from command_options import parse_help
from command_verdict import verdict
from limited_run import limit_this_process, run
from random_scenes import random_scene
from sandbox import Sandbox
from written_tables import differences, faults, is_time

HELP = """Usage: ours [OPTIONS] [scenes...]

Positionals:
  scenes TEXT=[cloth@0.1,chain] ...
                              names

Options:
  -h,--help                   Print this help message and exit
  --no-reduce TEXT ...        to leave in, of pins, duplicates
  --repeats INT=5             timed runs
  --amplitudes FLOAT=[0.03,0.1] ...
                              a,b,... the rows
  --explain                   say why
"""

# Writes ten rows, one each 50 ms, with a journal; a "bad" one counts its last row twice on
# --resume.
STUDY = """#!/usr/bin/python3
import json, os, signal, sys, time
out, resumed = "results", "--resume" in sys.argv
os.makedirs(out, exist_ok=True)
journal = out + "/study.journal"
lines = open(journal).read().split("\\n")[:-1] if resumed and os.path.exists(journal) else []
if lines and {bad}:
    lines[-1] += "0"
def end(*_):
    write(True)
    sys.exit(130)
def write(interrupted):
    for name, text in [("points.json", json.dumps({{"interrupted": "SIGINT"}} if interrupted else {{}})),
                       ("points.csv", "h,time_s\\n" + "".join(f"{{l}},{{time.time()}}\\n" for l in lines))]:
        open(out + "/" + name, "w").write(text)
signal.signal(signal.SIGINT, end)
signal.signal(signal.SIGTERM, end)
with open(journal, "w" if not resumed else "a") as file:
    for k in range(len(lines), 10):
        time.sleep(0.05)
        lines.append(str(k))
        file.write(f"{{k}}\\n")
        file.flush()
write(False)
"""


class TestOptions(unittest.TestCase):
    def test_reads_a_help_page(self):
        options = {option.name: option for option in parse_help(HELP)}
        self.assertEqual(
            list(options), ["scenes", "--no-reduce", "--repeats", "--amplitudes", "--explain"]
        )
        self.assertTrue(options["scenes"].positional and options["scenes"].several)
        self.assertEqual(options["--no-reduce"].choices, ["pins", "duplicates"])
        self.assertEqual((options["--repeats"].kind, options["--repeats"].default), ("INT", "5"))
        self.assertEqual(options["--amplitudes"].default, "[0.03,0.1]")
        self.assertEqual(options["--explain"].kind, "FLAG")


class TestVerdict(unittest.TestCase):
    def kinds(self, script, arguments=()):
        """What is found of a shell script that runs in a sandbox."""
        with tempfile.TemporaryDirectory() as place:
            sandbox = Sandbox(place + "/one", {"scene.toml": b"dimension = 1\n"})
            argv = ["/bin/sh", "-c", script]
            ended = run(argv, sandbox.here, sandbox.environment, 0.2, 0.5, patience=0.3)
            found = verdict("ours", list(arguments), ended, sandbox)
            sandbox.remove()
        return "; ".join(kind for kind, _ in found)

    def test_nothing_is_wrong_with_what_is_documented(self):
        table = "echo 'a,b' > t.csv; echo '1,2' >> t.csv; echo '{}' > t.json; "
        for script in [
            "true",
            table,
            "echo 'ours: --until: wrong' >&2; exit 2",
            table + "echo 'ours: 1 of 2 s reached' >&2; exit 3",
            "trap 'exit 130' INT; while :; do sleep 0.01; done",
        ]:
            self.assertEqual(self.kinds(script), "", script)

    def test_statuses_and_sentences(self):
        self.assertIn("undocumented status 1", self.kinds("echo 'ours: bad_alloc' >&2; exit 1"))
        self.assertIn("signal 11", self.kinds("kill -SEGV $$"))
        self.assertIn("0 lines", self.kinds("exit 2"))
        self.assertIn("2 lines", self.kinds("echo 'ours: a wrong one' >&2; echo more >&2; exit 2"))
        self.assertIn("without a sentence", self.kinds("echo 'theirs: a wrong one' >&2; exit 3"))
        self.assertIn("control character", self.kinds("printf '\\033[31m'"))

    def test_files(self):
        self.assertIn("an input was changed", self.kinds("echo >> scene.toml"))
        forced = ["--force", "--final", "sub/../scene.toml"]
        self.assertNotIn("an input was changed", self.kinds("echo >> scene.toml", forced))
        forced += ["--scene=link.toml"]
        self.assertIn("an input was changed", self.kinds("echo >> scene.toml", forced))
        self.assertIn("a user's own file", self.kinds("echo > end.json"))
        self.assertNotIn("a user's own file", self.kinds("echo '{}' > end.json", ["--force"]))
        self.assertIn("outside", self.kinds("echo > $HOME/x"))
        self.assertIn(
            "files are left", self.kinds("echo > new.part; echo 'ours: --until: wrong' >&2; exit 2")
        )
        self.assertIn("not whole", self.kinds("echo > new.csv.7.part"))
        self.assertIn(
            "not whole", self.kinds("echo 'a,b' > t.csv; echo '{}' > t.json; echo 1 >> t.csv")
        )
        self.assertIn("not whole", self.kinds("echo '{\"a\": NaN}' > t.json"))
        self.assertIn("not whole", self.kinds("echo 'a' > t.csv"))

    def test_time(self):
        self.assertIn("SIGINT: status -2", self.kinds("while :; do :; done"))
        self.assertIn("hangs", self.kinds("trap '' INT; while :; do :; done"))


class TestTables(unittest.TestCase):
    def test_compares_what_is_no_time(self):
        with tempfile.TemporaryDirectory() as place:
            for folder, text in [
                ("a", "h,time_s\n1,2\n"),
                ("b", "h,time_s\n1,3\n"),
                ("c", "h,time_s\n1.5,2\n"),
                ("d", "h,time_s\n"),
            ]:
                os.mkdir(f"{place}/{folder}")
                with open(f"{place}/{folder}/t.csv", "w", encoding="utf-8") as file:
                    file.write(text)
            self.assertEqual(list(differences(f"{place}/a", f"{place}/b")), [])
            self.assertEqual(len(list(differences(f"{place}/a", f"{place}/c"))), 1)
            self.assertEqual(len(list(differences(f"{place}/a", f"{place}/d"))), 1)
            self.assertIn("t.csv has no sidecar", list(faults(f"{place}/a", ["t.csv"])))
        self.assertTrue(all(map(is_time, ["time_s", "seconds", "setup_s", "springs_per_second"])))
        self.assertFalse(any(map(is_time, ["iteration", "damping_ratio", "blow_up_time", "t"])))


class TestKills(unittest.TestCase):
    def test_a_study_that_resumes_wrongly_is_found(self):
        for bad in (False, True):
            with tempfile.TemporaryDirectory() as place:
                with open(place + "/study", "w", encoding="utf-8") as file:
                    file.write(STUDY.format(bad=bad))
                os.chmod(place + "/study", 0o755)
                studies.LONG_STUDIES["study"] = "--any"
                a = fuzz_kills.arguments_of(["--bin", place, "--kills", "6", "--jobs", "3"])
                found = fuzz_kills.campaign(a, "study", place + "/work")
                self.assertEqual(found > 0, bad)


class TestScenes(unittest.TestCase):
    def test_scenes_repeat_with_their_seed(self):
        for seed in range(200):
            files = random_scene(random.Random(seed))
            self.assertEqual(files, random_scene(random.Random(seed)))
            self.assertIn("scene.toml", files)


if __name__ == "__main__":
    limit_this_process()
    unittest.main()
