"""The pages of methods: a new method gets one by itself, and one that says too little is refused."""

import unittest
from unittest import mock

import method_formula
import method_pages
import page_data
import render

FORMULA = "// A new method:\n//   q' = q + h v\n// It has order 1.\n\nMethod newest() {\n}\n"


def page_of(entry):
    """The page of a method that no study has measured."""
    method = method_pages.Method(entry["name"], entry)
    return render.environment().get_template("method.md").render(method=method)


class New(unittest.TestCase):
    def setUp(self):
        verlet = page_data.row("methods", "methods.csv", name="verlet")
        self.entry = {**verlet, "name": "newest", "summary": "the newest method"}

    def with_source(self, text):
        files = {"integrators/methods/newest.cpp": text} if text else {}
        sources = {**method_formula.sources(), **files}
        return mock.patch.object(method_formula, "sources", lambda: sources)

    def test_it_gets_a_page(self):
        with self.with_source(FORMULA):
            page = page_of(self.entry)
        source = "../../integrators/methods/newest.cpp"
        said = "The newest method", "```text\nq' = q + h v\n```", "It is not measured yet."
        self.assertEqual([w for w in ("# `newest`", *said, source) if w not in page], [])

    def test_one_that_says_too_little_is_refused(self):
        without = FORMULA.replace("//   q'", "// q'")
        for text, source, words in (
            ("", "a book", "no file defines it"), (without, "a book", "no formula"),
            (FORMULA, "", ""),
        ):  # fmt: skip
            self.entry["source"] = source
            with self.with_source(text), self.assertRaisesRegex(page_data.BadPage, words):
                page_of(self.entry)


class Formula(unittest.TestCase):
    def test_each_method_has_one(self):
        for method in method_pages.all_methods():
            with self.subTest(method=method.name):
                self.assertIn("```text\n", method.formula)

    def test_a_comment_becomes_markdown(self):
        lines = [" One_two of `a_b`:", "   x = y * z", "     + w", " and < three.", "", " Four."]
        self.assertEqual(
            "One\\_two of `a_b`:\n\n```text\nx = y * z\n  + w\n```\n\nand \\< three.\n\nFour.",
            method_formula.as_markdown(lines),
        )
