"""The pages of docs/ and README.md: what they say is measured, their links lead somewhere, and
their samples run."""

import re
import subprocess
import tempfile
import tomllib
import unittest
from pathlib import Path

import page_text
import study as entries
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
                    self.assertEqual("", study.due())
                for name in study.pictures.values():
                    self.assertTrue((entries.PICTURES / f"{name}.png").exists())


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
        printed = run("simulate --list-methods --csv").stdout
        names = {row["name"] for row in rows_of(printed)}
        self.assertEqual(names, {page.stem for page in METHOD_PAGES})
