"""The pages of docs/ and README.md: what they say is measured, links lead somewhere, samples run."""

import csv
import json
import re
import subprocess
import tempfile
import tomllib
import unittest
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from unittest import mock

import chart_data
import page_data
import page_text
import render
import repeated
import studies
import study as entries
import whole_runs
from programs import BIN, rows_of, run

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
METHOD_PAGES = sorted((ROOT / "docs/methods").glob("*.md"))
TEMPLATES = sorted((ROOT / "docs/pages").glob("*.md"))


def named(page):
    """The path of a page as a message shows it."""
    return page.relative_to(ROOT).as_posix()


def blocks(text, language):
    """The code blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


class Links(unittest.TestCase):
    def test_each_leads_to_a_file_and_a_heading(self):
        for page in PAGES + METHOD_PAGES:
            text = page_text.without_code(page.read_text(encoding="utf-8"))
            for target in re.findall(r"\]\(([^)\s]+)\)", text):
                if re.match(r"https?:", target):
                    continue
                path, _, anchor = target.partition("#")
                file = (page.parent / path) if path else page
                with self.subTest(page=named(page), target=target):
                    self.assertTrue(file.exists())
                    if anchor:
                        self.assertIn(anchor, page_text.anchors(file.read_text(encoding="utf-8")))

    def test_each_page_and_picture_is_used(self):
        everything = "".join(page.read_text(encoding="utf-8") for page in PAGES + METHOD_PAGES)
        for picture in (ROOT / "docs/pictures").iterdir():
            self.assertIn(f"pictures/{picture.name}", everything)
        index = (ROOT / "docs/index.md").read_text(encoding="utf-8")
        for page in (ROOT / "docs").glob("*.md"):
            if page.stem != "index":
                self.assertRegex(index, rf"\b{page.stem}\b")


class Numbers(unittest.TestCase):
    def test_none_that_was_measured_is_typed(self):
        found = page_text.typed_numbers("It takes 3.4 ms.\nh = 2 ms is a choice.{# chosen #}\n")
        self.assertEqual([(1, "3.4 ms")], found)
        for template in TEMPLATES:
            for line, number in page_text.typed_numbers(template.read_text(encoding="utf-8")):
                with self.subTest(template=named(template), line=line):
                    self.fail(f"'{number}' is typed; it has to come from docs/data")

    def test_pages_are_what_their_templates_and_data_say(self):
        done = subprocess.run(
            ["/usr/bin/python3", "-B", ROOT / "docs/site/render.py", "--check"],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)

    def test_each_study_is_there_and_prints_what_pages_show(self):
        for study in entries.read_studies().values():
            with self.subTest(study=study.name):
                self.assertIsNotNone(study.record)
                if study.quick:
                    self.assertEqual("", study.due(), "./run docs makes it anew")
                for name in study.pictures.values():
                    self.assertTrue((entries.PICTURES / f"{name}.png").exists())


class Runner(unittest.TestCase):
    """The studies that `./run studies` measures and keeps."""

    def test_a_study_is_kept_where_it_ends_well_and_due_where_it_is_another(self):
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name in ("DATA", "PICTURES"):
            self.enterContext(mock.patch.object(entries, name, folder / name))
        self.enterContext(mock.patch.object(entries, "MEASURED", str(folder / "MEASURED")))
        command = "simulate --scene examples/two_links.toml --explain"
        study = entries.Study("list", [command], text="m.csv")
        self.assertEqual("not measured", study.due())
        for sources, goes_on in ((entries.source_hash(), True), ("others", False)):
            begun = {"source_hash": sources, "commands": study.commands, "seconds": 100}
            entries.write_whole(study.folder / "begun.json", json.dumps(begun))
            studies.make(study, again=False)
            self.assertEqual((goes_on, ""), (study.record["seconds"] >= 100, study.due()))
        with mock.patch.object(entries, "digest", lambda file: "another"):
            self.assertEqual("changed since: examples/two_links.toml", study.due())
        study.commands = ["simulate --list-scenes --csv"]
        self.assertIn("measured by another command", study.due())
        bad = entries.Study("bad", ["convergence --scene nothing"], tables=["order.csv"])
        self.assertRaises(SystemExit, studies.make, bad, again=False)
        self.assertIsNone(bad.record)


    def test_a_study_that_is_named_and_not_due_is_repeated_beside_its_data(self):
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name, place in (("DATA", Path), ("PICTURES", Path), ("MEASURED", str), ("REPEATED", str)):
            self.enterContext(mock.patch.object(entries, name, place(folder / name)))
        command = "exchange --scene fpu --until 1 --methods verlet --h-omega 0.5"
        study = entries.Study("tiny", [command], tables=["summary.csv"])
        self.enterContext(mock.patch.object(studies, "read_studies", lambda: {"tiny": study}))
        self.assertIn("tiny: exchange", self.printed_by("tiny"))  # not measured yet, so it is kept
        record = json.loads((study.data / "study.json").read_text())
        entries.write_whole(study.data / "study.json", json.dumps({**record, "processor": "an abacus"}))
        rows = repeated.read(study.data / "summary.csv")
        row = next(row for row in rows if row["method"] == "verlet")
        true = row["energy_error"]
        row["energy_error"] = f"{float(true) / 2:.6g}"
        text = StringIO()
        csv.DictWriter(text, row).writerows([dict(zip(row, row)), *rows])
        entries.write_whole(study.data / "summary.csv", text.getvalue())
        before = {file: file.read_bytes() for file in (folder / "DATA").rglob("*.*")}

        said = self.printed_by("tiny")
        self.assertRegex(said, r"(?m)^then: an abacus, \d{4}-\d\d-\d\d")
        self.assertIn(f"now:  {studies.processor()}", said)
        numbers = rf"2\.0 +{re.escape(row['energy_error'])} +{re.escape(true)}"
        self.assertRegex(said, rf"(?m)^ +{numbers}  energy_error of verlet")
        self.assertNotIn("force_evaluations", said)  # is the same
        self.assertEqual(before, {file: file.read_bytes() for file in (folder / "DATA").rglob("*.*")})
        self.assertTrue((folder / "REPEATED/tiny/comparison.csv").exists())
        # Without a name there is nothing to do, and --again measures for the pages.
        self.assertEqual("", self.printed_by())
        self.printed_by("tiny", "--again")
        self.assertEqual(studies.processor(), study.record["processor"])

    def test_a_second_processor_has_columns_of_its_own(self):
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        data = folder / "DATA"
        for name, place in (("PICTURES", Path), ("MEASURED", str), ("ON_SECOND", str)):
            self.enterContext(mock.patch.object(entries, name, place(folder / name)))
        for module in (entries, page_data):
            self.enterContext(mock.patch.object(module, "DATA", data))
        command = "exchange --scene fpu --until 1 --methods verlet --h-omega 0.5"
        study = entries.Study("tiny", [command], tables=["summary.csv"])
        self.enterContext(mock.patch.object(studies, "read_studies", lambda: {"tiny": study}))
        # There is nothing to be second to.
        self.assertEqual(2, self.refused("tiny", "--second"))
        self.printed_by("tiny")
        self.assertEqual(2, self.refused("tiny", "--second"))
        self.assertEqual(2, self.refused("--second"))
        self.assertEqual((["tiny"], "rate"), (page_data.measured("tiny"), page_data.column("rate", "tiny")))
        first = {**study.record, "processor": "an abacus"}
        entries.write_whole(study.data / "study.json", json.dumps(first))
        page_data.record.cache_clear()

        self.printed_by("tiny", "--second")
        self.assertEqual(first, study.record)
        both = page_data.measured("tiny")
        self.assertEqual(["tiny", "tiny/second"], both)
        names = [page_data.column("rate", name) for name in both]
        self.assertEqual(["an abacus: rate", f"{studies.processor()}: rate"], names)
        for name in both:
            self.assertEqual("verlet", page_data.row(name, "summary.csv", method="verlet")["method"])
        self.assertEqual([], sorted((folder / "PICTURES").rglob("*")))

    def refused(self, *words):
        """The exit status of ./run studies with these words."""
        with mock.patch("sys.argv", ["studies.py", *words]), redirect_stderr(StringIO()):
            with self.assertRaises(SystemExit) as ended:
                studies.main()
        return ended.exception.code

    def printed_by(self, *words):
        """What ./run studies prints with these words."""
        with mock.patch("sys.argv", ["studies.py", *words]), redirect_stdout(StringIO()) as printed:
            self.assertEqual(0, studies.main())
        return printed.getvalue()


class Repeated(unittest.TestCase):
    """Tables of a study then and now."""

    def test_rows_are_found_by_what_was_asked_for(self):
        run = {"method": "dprkn8", "outcome": "reached_end", "rate": "1", "knob": "rtol", "time_s": "2"}
        then = [{**run, "value": value} for value in ("0.1", "0.01")]
        now = [{**row, "rate": "5", "time_s": "3"} for row in then[::-1]]
        figures, gone, new = repeated.compared("summary.csv", then, now + [{**run, "value": "1e-3"}])
        self.assertEqual((0, 1), (gone, new))
        seen = {(one.column, one.key, one.ratio) for one in figures}
        keys = [f"dprkn8 rtol {value}" for value in ("0.1", "0.01")]
        self.assertEqual({(c, k, r) for k in keys for c, r in (("rate", 5), ("time_s", 1.5))}, seen)

    def test_ratios_come_first(self):
        then = [{"scene": "cloth", "time_s": "1", "margin": "2", "method": "verlet"}]
        now = [{**then[0], "time_s": "3", "margin": "2.2"}]
        figures, _, _ = repeated.compared("crossover.csv", then, now)
        self.assertEqual(["margin", "time_s"], [one.column for one in figures])

    def test_many_figures_are_summed_up_by_column(self):
        then = [{"nodes": str(n), "seconds": "2", "verdict": "lives"} for n in range(1, 202)]
        now = [{**row, "seconds": str(2 * int(row["nodes"]))} for row in then]
        now[6]["verdict"] = "dies"
        figures, _, _ = repeated.compared("modal.csv", then, now)
        lines = [" ".join(line.split()) for line in repeated.figure_lines(figures)]
        # The ratios are 1 to 201: the median is 101 and the quartiles 51 and 151, in two digits.
        self.assertIn("100 51 150 200 of 201 seconds", lines)
        self.assertIn("7: lives, now dies", lines)
        self.assertEqual(4, len(lines))

    def test_text_is_compared_by_line(self):
        self.assertEqual(["  prints the same"], list(repeated.text_lines("a\nb\n", "a\nb\n")))
        found = list(repeated.text_lines("a\nb\n", "a\nc\nd\n"))
        self.assertEqual(["  then: b", "  now:  c", "  then: ", "  now:  d"], found)


class Form(unittest.TestCase):
    def test_readme_is_short(self):
        lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
        self.assertLessEqual(len(lines), 150)

    def test_each_column_of_a_table_has_a_head(self):
        for page in PAGES + METHOD_PAGES:
            for head in page_text.table_heads(page.read_text(encoding="utf-8")):
                with self.subTest(page=named(page), table=" | ".join(head)):
                    self.assertTrue(all(head))


class Samples(unittest.TestCase):
    def test_scenes_and_studies_are_read(self):
        for page in PAGES:
            for block in blocks(page.read_text(encoding="utf-8"), "toml"):
                with self.subTest(page=named(page), block=block[:60]):
                    self.read_sample(block)

    def read_sample(self, block):
        """A scene is explained, a study planned; what needs a mesh or is a part of a file is parsed."""
        content = tomllib.loads(block)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "sample.toml"
            file.write_text(block, encoding="utf-8")
            if "scenes" in content:
                (Path(folder) / "my.toml").write_text('[generator]\nkind = "chain"\n')
                done = run(["sweep", "plan", file, "--out", Path(folder) / "S"])
            elif content.keys() & {"nodes", "generator"} and "mesh" not in content:
                done = run(["simulate", "--scene", file, "--explain"])
            else:
                return
            self.assertEqual(0, done.returncode, done.stderr)

    def test_commands_exist(self):
        usage = subprocess.run(
            [ROOT / "run", "help"], capture_output=True, text=True, check=True
        ).stdout
        helps = {}
        for page in PAGES:
            text = page.read_text(encoding="utf-8")
            for line in page_text.commands("".join(blocks(text, "sh"))):
                with self.subTest(page=named(page), command=line):
                    self.assert_exists(line, usage, helps)

    def assert_exists(self, line, usage, helps):
        """Whether a command is one of ./run's, or a program with these options."""
        name = re.match(r"(?:\./run|(?:\S*/)?build/bin/)\s*([a-z_]+)", line)
        if not name:
            return
        if line.startswith("./run"):
            self.assertRegex(usage, rf"(?m)^  {name[1]}\b")
            return
        if not Path(BIN, name[1]).exists():  # one that only some builds have
            self.assertIn(name[1], {"bench"})
            return
        if name[1] not in helps:
            helps[name[1]] = run([name[1], "--help"]).stdout
        words = re.match(r"\S+ (plan|run|merge|submit|status)\b", line)
        if name[1] == "sweep" and words:
            helps[name[1]] = run(["sweep", words[1], "--help"]).stdout
            if words[1] == "submit":
                return  # what follows belongs to another scheduler
        for option in re.findall(r"\s(--[a-z-]+)", line):
            self.assertIn(option, helps[name[1]])


class Methods(unittest.TestCase):
    def test_each_has_a_page(self):
        printed = run("simulate --list-methods --newer --csv").stdout
        names = {row["name"] for row in rows_of(printed)}
        self.assertEqual(names, {page.stem for page in METHOD_PAGES}, "./run docs makes the pages")


class Words(unittest.TestCase):
    def test_numbers(self):
        for value, words in ((0.00098, "0.98 ms"), (1.23e-5, "12 µs"), (9.96e-5, "0.10 ms"), (0.1234, "0.12 s"),
                             (99.6, "1 min 40 s"), (120, "2 min"), (3e-8, "30 ns"), (0.0099, "9.9 ms")):  # fmt: skip
            self.assertEqual(words, page_data.seconds(value))
        for value, words in ((1.04, "1.0"), (12.5, "12"), (12345, "12,000"), (9.1e-7, "9.1e-7"), (0, "0"),
                             (-0.25, "−0.25"), (float("inf"), "∞"), (1e-4, "1e-4"), (0.996, "1.0")):  # fmt: skip
            self.assertEqual(words, page_data.figures(value))
        self.assertEqual(("1e-3", "97 %"), (page_data.accuracy(0.001), page_data.percent(0.974)))

    def test_a_page_names_a_study_a_processor_and_a_date_once(self):
        records = {
            name: {"processor": processor, "date": date}
            for name, processor, date in (
                ("a", "abacus", "1"), ("b", "abacus", "1"), ("c", "abacus", "2"), ("d", "slide rule", "2"),
            )
        }  # fmt: skip
        with mock.patch.object(page_data, "record", records.get), mock.patch.object(
            page_data, "said_on_page", set()
        ):
            said = [page_data.made(*names) for names in ("a", "a", "ab", "c", "ad", "abcd")]
        self.assertEqual(
            ["(`./run studies a`; one core of an abacus, 1)", page_data.UNSAID, "(`./run studies b`)",
             "(`./run studies c`; 2)", "(`./run studies d`; one core of an slide rule)", page_data.UNSAID],
            said,
        )  # fmt: skip
        page = f"Forces {page_data.UNSAID}: one\n{page_data.UNSAID}.\n\n{page_data.UNSAID}\n\nEnd\n"
        self.assertEqual("Forces: one.\n\nEnd\n", render.without_unsaid(page))

    def test_what_is_not_there_is_an_error(self):
        for call in (
            lambda: page_data.record("nothing"), lambda: page_data.rows("methods", "nothing.csv"),
            lambda: page_data.rows("methods", "methods.csv", nothing=1),
            lambda: page_data.row("methods", "methods.csv", family="sundials"),
            lambda: page_data.sample("README.md", "a line that nobody wrote " * 2),
        ):  # fmt: skip
            with self.assertRaises(page_data.BadPage):
                call()

    def test_the_fastest_is_the_fastest(self):
        runs = [run for run in chart_data.runs("cloth") if not run.failure and run.counts_at <= 1e-4]
        best = chart_data.fastest("cloth", 1e-4)
        self.assertEqual(min(run.time for run in runs), best.seconds)
        second = chart_data.fastest("cloth", 1e-4, but=[best.method])
        self.assertTrue(second.method != best.method and second.seconds >= best.seconds)
        self.assertFalse(chart_data.fastest("cloth", 1e-4, of=["explicit_euler"]))


class Leads(unittest.TestCase):
    """Which kind of methods is the fastest at which measured stiffness ratio."""

    def leads_of(self, times):
        """The last ratio at which explicit methods lead and the first from which implicit ones do,
        with these times of both by ratio; None: not reached."""
        cells = [
            {"stiffness_ratio": ratio, "kind": kind, "method": time and "m", "time_s": time or ""}
            for ratio, pair in times.items()
            for kind, time in zip(("explicit", "implicit"), pair)
        ]
        with mock.patch.object(chart_data, "rows", lambda *_, **__: cells):
            return (
                chart_data.leads_to("made", 1e-3, "explicit"),
                chart_data.leads_from("made", 1e-3, "implicit"),
            )

    def test_the_lead_changes_between_two_measured_ratios(self):
        # Explicit time grows as the root of the ratio, implicit time stays: they meet at 900.
        times = {10.0**n: (10 ** (n / 2), 30) for n in range(7)}
        self.assertEqual((100, 1000), self.leads_of({**times, 1000: (40, 30)}))
        # Nobody leads by less than a tenth, whatever the sign.
        for near in (31, 29):
            self.assertEqual((100, 10000), self.leads_of({**times, 1000: (near, 30)}))

    def test_one_kind_can_lead_throughout(self):
        self.assertEqual((None, 1), self.leads_of({1: (2, 1), 10: (3, 1)}))
        self.assertEqual((10, None), self.leads_of({1: (1, 2), 10: (1, 2)}))

    def test_a_ratio_that_no_kind_reaches_says_nothing(self):
        times = {1: (1, 2), 10: (None, 2), 100: (None, None)}
        self.assertEqual((1, 10), self.leads_of(times))

    def test_a_lead_that_is_lost_again_is_none(self):
        lost = {1: (2, 1), 10: (2, 1), 100: (1, 2), 1000: (2, 1)}
        self.assertEqual((None, 1000), self.leads_of(lost))


class WholeRuns(unittest.TestCase):
    """Up to which step size all runs of a method held."""

    def endurance_of(self, outcomes):
        """That of runs with h ω = 1, 2, ... which end so; their energy peaks at the same numbers."""
        runs = [
            {"h_omega": str(k), "outcome": outcome, "energy_max": str(k)}
            for k, outcome in enumerate(outcomes, 1)
        ]
        return whole_runs.endurance(runs[::-1])

    def test_a_single_failure_is_no_limit_from_which_on_runs_fail(self):
        found = self.endurance_of(["bounded", "gained", "bounded", "leaked", "bounded"])
        self.assertEqual((1, 2, 4, 1), (found.held_to, found.failed_from, found.longer, found.failed))
        self.assertEqual("1.0; 1 of 4", whole_runs.endurance_words(found))

    def test_a_longer_step_that_holds_is_not_counted_as_failed(self):
        found = self.endurance_of(["bounded", "leaked", "newton_failed", "gained", "bounded", "diverged"])
        self.assertEqual((2, 3, 4, 3), (found.held_to, found.failed_from, found.longer, found.failed))
        self.assertEqual((2, 4), (found.grown, found.least_growth))

    def test_all_can_hold_or_fail(self):
        for outcomes, words in ((["bounded", "leaked"], "2.0; none"), (["gained"] * 3, "–; 3 of 3")):
            self.assertEqual(words, whole_runs.endurance_words(self.endurance_of(outcomes)))
        self.assertRaises(page_data.BadPage, whole_runs.endurance, [])

    def test_amplitudes_count_together(self):
        """A step holds where the runs of all amplitudes do."""
        runs = [
            {"h_omega": h, "amplitude": amplitude, "outcome": outcome, "energy_max": "9"}
            for amplitude, outcomes in (("1", ("bounded", "bounded")), ("2", ("bounded", "gained")))
            for h, outcome in zip("12", outcomes)
        ]
        self.assertEqual("1.0; 1 of 2", whole_runs.endurance_words(whole_runs.endurance(runs)))
