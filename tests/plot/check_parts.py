"""Whether the parts of the pictures read tables and records, choose what stands out, place labels
and word numbers as they say."""

import json
import math
import tempfile
import unittest
from pathlib import Path

import band
import causes
import damping_panels
import emphasis
import failures
import labels
import names
import outcomes
import prominent
import record
import style
from measurements import BadInput
from record import FrontPoint, Run

HEADER = "scene,method,family,stock_of,knob,value,outcome,time_s\n"
A_ROW = "s,ida_klu,sundials,ida,rtol,1e-4,reached_end,0.5\n"


def a_run(method="verlet", value=1e-3, error=1e-3, time=1.0, **others):
    """A run that reached the end, or one that ended in another way."""
    facts = {"scene": "s", "family": "hand-written", "stock_of": "", "knob": "step_size"}
    facts |= {"method": method, "value": value, "time": time, "solves": 0, "knob_words": "h = 1 s"}
    facts |= {"error": error, "at_least": error, "at_most": error, "counts": True}
    facts |= {"counts_at": error, "is_lucky": False}
    outcome = others.setdefault("outcome", "reached_end")
    failure = "" if outcome == "reached_end" else outcome.replace("_", " ")
    facts |= {"is_uncertain": False, "failure": failure.replace("newton", "Newton")}
    return Run(**(facts | others))


def a_view(runs):
    """The view of these runs, with the front that they make."""
    good = sorted((run for run in runs if not run.failure), key=lambda run: run.time)
    accuracies = [10.0**-digit for digit in range(1, 10)]
    ranked = {a: [run for run in good if run.at_most <= a] for a in accuracies}
    front = [
        FrontPoint(accuracy, fastest[0].method, fastest[0].time)
        for accuracy, fastest in ranked.items()
        if fastest
    ]
    return record.View("", record.QUANTITIES["position"], "", runs, front, ranked, [])


class Records(unittest.TestCase):
    """Reading of points.csv and chart.json."""

    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        self.position = {"name": "position", "column": "error_position", "floor": 1e-9}
        self.position |= {"floor_words": "certified", "rounding_decides_below": None}
        self.position |= {"errors": [2e-3], "at_least": [1e-3], "at_most": [3e-3], "counts": [True]}
        self.position |= {"is_uncertain": [True], "failures": [""], "staircase": [0]}
        row = {"accuracy": 1e-2, "point": 0, "ranked": [0]}
        self.position["front"] = [row, row | {"accuracy": 1e-3, "point": None, "ranked": []}]
        self.chart = {"scene": "s", "until": 2, "judged_by": "position", "caveats": ["careful"]}
        self.chart |= {"displacements": [0.5, 2], "knobs": ["rtol = 1e-4"], "rows": [row]}
        self.chart["quantities"] = [self.position]

    def read(self, table=HEADER + A_ROW):
        """The record of a folder with this table."""
        Path(self.folder, "points.csv").write_text(table, encoding="utf-8")
        Path(self.folder, "chart.json").write_text(json.dumps(self.chart), encoding="utf-8")
        return record.read_record(self.folder)

    def refusal(self, table=HEADER + A_ROW):
        """Why a folder with this table is refused."""
        with self.assertRaises(BadInput) as refused:
            self.read(table)
        return str(refused.exception).replace(self.folder, "DIR")

    def test_a_row_and_its_judgement_become_a_run(self):
        view = self.read().judged
        (run,) = view.runs
        self.assertEqual((run.method, run.family, run.stock_of), ("ida_klu", "sundials", "ida"))
        self.assertEqual((run.value, run.time, run.knob_words), (1e-4, 0.5, "rtol = 1e-4"))
        self.assertEqual((run.error, run.at_least, run.at_most), (2e-3, 1e-3, 3e-3))
        self.assertTrue(run.is_uncertain and run.counts and not run.failure)
        self.assertEqual((run.counts_at, run.is_lucky), (3e-3, False))
        self.assertEqual(view.front, [FrontPoint(1e-2, "ida_klu", 0.5)])
        self.assertEqual((view.ranked, view.staircase), ({1e-2: [run], 1e-3: []}, [run]))
        self.assertTrue(view.subtitle.endswith(" in the node's own part, 0.5 to 2 m"))
        self.position |= {"counts_at": [0.2], "is_lucky": [True]}
        (run,) = self.read().judged.runs
        self.assertEqual((run.at_most, run.counts_at, run.is_lucky), (3e-3, 0.2, True))
        self.position["errors"] = [None]  # one that is not known
        self.assertTrue(math.isnan(self.read().judged.runs[0].error))

    def test_a_refusal_names_file_line_and_cell(self):
        row = "s,verlet,hand-written,,step_size,{},reached_end,1\n"
        for table, words in (
            (HEADER + A_ROW + row.format("tiny"), ", line 3: value is 'tiny', not a number"),
            (HEADER + row.format("-1"), ", line 2: value must be a positive number"),
            (HEADER.replace(",time_s", ""), " has no column time_s"),
            (
                HEADER + "s,,hand-written,,step_size,1,reached_end,1\n",
                ", line 2: method, knob and outcome must not be empty",
            ),
        ):
            self.assertEqual(self.refusal(table), f"DIR/points.csv{words}.")
        self.assertRegex(self.refusal(HEADER + A_ROW + A_ROW), "^DIR/chart.json cannot be read: ")
        del self.chart["knobs"]
        self.assertEqual(self.refusal(), "DIR/chart.json cannot be read: 'knobs'.")
        Path(self.folder, "chart.json").unlink()
        with self.assertRaisesRegex(BadInput, "missing: work_precision --judge .* makes it"):
            record.read_record(self.folder)


class Prominent(unittest.TestCase):
    """The methods that stand out, and how strongly lines are drawn."""

    def strong(self, runs):
        """Their names, with the front that these runs make."""
        return prominent.strong_methods(a_view(runs))

    def test_the_front_and_then_the_best_of_each_kind(self):
        runs = [
            *(a_run(f"slow{i}", error=5e-2, time=100 + i) for i in range(20)),
            a_run("fine", error=1e-8, time=2), a_run("coarse", error=1e-3, time=1),
            a_run("solving", error=1e-3, time=40, solves=10),
            a_run("solving_slowly", error=1e-3, time=41, solves=10),
            a_run("bdf", error=1e-5, time=9, family="sundials", solves=10),
            a_run("erk", error=1e-7, time=8, family="sundials"),
            a_run("bdf_klu", error=1e-5, time=10, family="sundials", stock_of="bdf", solves=9),
        ]  # fmt: skip
        # The best of SUNDIALS comes before what solves linear systems in either family.
        expected = ["coarse", "fine", "erk", "bdf_klu", "solving", "bdf"]
        self.assertEqual(self.strong(runs), expected)
        # Lines that stand out have full colour, and the rest is pale.
        view = a_view(runs)
        chosen = emphasis.Prominent([view])
        strokes = {s[0].method: chosen.stroke(view, s) for s in record.sweeps(runs)}
        self.assertEqual(strokes["fine"].alpha, 1)
        self.assertGreater(min(style.to_rgb(strokes["slow3"].color)), 0.7)
        widths = [strokes[name].line["linewidth"] for name in ("slow3", "fine")]
        self.assertLess(*widths)
        self.assertEqual(chosen.looks["bdf_klu"].family, style.STOCK)
        # Among few lines, far ones are not faint.
        everything = emphasis.Everything([view])
        alphas = {everything.stroke(view, sweep).alpha for sweep in record.sweeps(runs)}
        self.assertEqual(alphas, {emphasis.BACKGROUND, 1.0})

    def test_at_most_a_dozen(self):
        # Nine methods on the front and a best of each of six families more.
        runs = [a_run(f"front{i}", error=5 * 0.1**i, time=i) for i in range(2, 11)]
        runs += [a_run(f"f{i}", error=1e-2, time=50, family=f"family{i}") for i in range(6)]
        strong = self.strong(runs)
        self.assertEqual(len(strong), prominent.MOST)
        self.assertEqual(strong[:10], [f"front{i}" for i in range(2, 11)] + ["f0"])
        # a goes from 1e-1 to 1e-3 and half a decade beyond, b from there on.
        front = a_view([a_run("a", error=5e-4), a_run("b", error=5e-6, time=2)]).front
        ends = [(name, *map(math.log10, ends)) for name, *ends in band.stretches(front)]
        for found, wanted in zip(ends, (("a", -3.5, -0.5), ("b", -5.5, -3.5)), strict=True):
            for one, other in zip(found, wanted):
                self.assertAlmostEqual(one, other)

    def test_where_none_is_accurate_the_smallest_error(self):
        runs = [a_run(f"m{i}", error=2 - 0.05 * i, time=1 + i) for i in range(20)]
        self.assertEqual(self.strong(runs), ["m19"])
        self.assertEqual(self.strong([a_run(outcome="diverged")]), [])


class Endurance(unittest.TestCase):
    """Up to which step size all runs of a map hold, in words."""

    def note_of(self, rows, limit=math.inf):
        """The words of a panel with runs at h w = 1, 10, ..., a row an amplitude."""
        runs = [
            outcomes.Run("m", "step_size", 1, 1, 10.0**i, amplitude, outcome, 0, 1, 0)
            for amplitude, row in enumerate(rows)
            for i, outcome in enumerate(row)
        ]
        return outcomes.Panel(["m"], limit, runs).note

    def test_a_run_that_fails_ends_it_though_longer_steps_hold_again(self):
        self.assertEqual(self.note_of([["bounded", "gained", "bounded"]]), "all hold to 1")
        rows = [["bounded"] * 3, ["bounded", "leaked", "newton_failed"]]
        self.assertEqual(self.note_of(rows, limit=2), "limit 2, all hold to 10")

    def test_all_or_none(self):
        self.assertEqual(self.note_of([["leaked"] * 3]), "all hold")
        self.assertEqual(self.note_of([["diverged"] * 3], limit=0), "limit 0, one fails at 1")
        self.assertEqual(self.note_of([["over_budget"] * 3]), "not finished")


class Damping(unittest.TestCase):
    """The line of a method over the modes of a scene."""

    def test_it_leaves_out_a_mode_without_a_prediction(self):
        curve = damping_panels.Curve(["m"], [(0.5, 0.1), (1.0, math.nan)], [(1, 1)], None)
        rows = [
            {"h_omega": x, "damping_ratio_predicted": y} for x, y in ((0.5, 0.1), (1.0, math.nan))
        ]
        sheet = damping_panels.DampingSheet.__new__(damping_panels.DampingSheet)
        self.assertEqual(sheet.predicted(curve, rows, 1 / (2 * math.pi)), [(0.5, 0.1)])

    def test_that_of_a_damped_scene_goes_through_its_modes_alone(self):
        points = [(0.5, 0.0), (0.7, 0.0), (1.0, 0.0)]
        curve = damping_panels.Curve(["m"], points, [(1, 1)], None)
        rows = [
            {
                "omega": 2 * math.pi * x,
                "h_omega": x,
                "damping_ratio_predicted": 2 * x,
                "damping_ratio_physical": str(x),
            }
            for x in (1.0, 0.5)
        ]
        sheet = damping_panels.DampingSheet.__new__(damping_panels.DampingSheet)
        line = sheet.predicted(curve, rows, 1 / (2 * math.pi))
        self.assertEqual(line, [(0.5, 1.0), (1.0, 2.0)])
        self.assertEqual(damping_panels.own_damping(rows), [(0.5, 0.5), (1.0, 1.0)])
        rows = [row | {"damping_ratio_physical": "0"} for row in rows]
        self.assertEqual(damping_panels.own_damping(rows), [])


class Causes(unittest.TestCase):
    """The strip of failures, by cause."""

    def sweep(self, method, ends, knob="step_size"):
        """The runs of a method at 1e-4, 1e-3, ...; None reached its end."""
        return [
            a_run(method, 10.0 ** (i - 4), knob=knob, outcome=outcome or "reached_end")
            for i, outcome in enumerate(ends)
        ]

    def lines(self, *sweeps):
        """The lines of the strip as (cause, number of methods, fullest words)."""
        found = causes.lines(failures.failing(sweeps))
        return [(cause, len(names), words[0]) for cause, names, words in found]

    def test_limits_from_the_least_to_the_largest(self):
        found = self.lines(
            self.sweep("a", ["over_budget", None, None, "diverged"]),
            self.sweep("b", [None, None, "diverged", "diverged"]),
            self.sweep("c", [None, "newton_failed", None, None], "rtol"),
            self.sweep("good", [None, None]),
        )
        expected = [
            ("diverged", 2, "h ≥ 1e-2 (b) to 0.1 (a)"), ("over budget", 1, "h ≤ 1e-4 (a)"),
            ("Newton failed", 1, "some rtol between"),
        ]  # fmt: skip
        self.assertEqual(found, expected)
        shorter = causes.shortening(["a", "b", "c"])[1:]
        self.assertEqual(shorter, ["a, b and 1 more", "a and 2 more"])

    def test_the_strip_is_low_whatever_failed(self):
        sweeps = [self.sweep(f"m{i}", [f"cause_{i % 9}", None, f"end_{i}"]) for i in range(60)]
        sweeps += [self.sweep(f"none{i}", ["lost", "lost"]) for i in range(60)]
        height = causes.strip_height(failures.failing(sweeps))
        # Six lines and a title; 4 cm are 1.57 in, and without a limit it would be 15 in.
        self.assertLess(height, 1.7)
        self.assertEqual((self.lines(*sweeps)[-1][0], causes.strip_height({})), ("other causes", 0))


class Looks(unittest.TestCase):
    """Colours, markers and lines of methods."""

    def test_no_two_methods_of_a_family_look_alike(self):
        looks = style.assign_looks({f"m{i}": ("hand-written", "") for i in range(42)})
        self.assertEqual(len({(look.color, look.marker) for look in looks.values()}), 42)

    def test_a_stock_way_looks_like_its_method_but_for_the_line(self):
        known = {name: ("sundials", "") for name in ("pale", "own", "strong")}
        known["own_klu"] = ("sundials", "own")
        looks = prominent.looks_by_prominence(known, ["own_klu", "strong"])
        # Those that stand out come first, and a stock way takes no colour away from the others.
        self.assertEqual(list(looks), ["own", "strong", "own_klu", "pale"])
        own, stock = looks["own"], looks["own_klu"]
        self.assertEqual((own.color, own.marker), (stock.color, stock.marker))
        self.assertNotEqual(own.family.line, stock.family.line)
        self.assertEqual((own.color, looks["pale"].color), (style.COOL[0], style.COOL[2]))
        # Without its method in the picture it is one of its family.
        alone = style.assign_looks({"other": ("sundials", "ida")})["other"]
        self.assertEqual(alone.family, style.FAMILIES["sundials"])

    def test_letters_are_dark_enough_for_white(self):
        # A contrast of 4.5 asks for a relative luminance below 0.18; of the sum of sRGB values,
        # which this is, 0.42 is about that for a grey.
        for color in (*style.WARM, *style.COOL):
            text = style.Look(color, "o", style.FAMILIES["sundials"]).text_color
            red, green, blue = style.to_rgb(text)
            self.assertLess(0.2126 * red + 0.7152 * green + 0.0722 * blue, 0.43)


class Words(unittest.TestCase):
    """Numbers and names as they are shown."""

    def test_numbers(self):
        numbers = (0.5, "0.5"), (0.1, "0.1"), (999, "999"), (1000, "1e3"), (2e-3, "2e-3")
        numbers += (3.34e-14, "3.3e-14"), (-2.5e6, "-2.5e6")
        powers = (1e-3, "1e-3"), (1, "1"), (10, "10"), (1e5, "1e5")
        times = (3, "3 s"), (5e-3, "5 ms"), (2e-5, "20 µs"), (4e-9, "4 ns"), (1e-12, "0.001 ns")
        for shown, pairs in (
            (style.number, numbers), (style.power_of_ten, powers), (style.seconds, times)
        ):  # fmt: skip
            self.assertEqual([shown(x) for x, _ in pairs], [words for _, words in pairs])
        self.assertEqual(style.seconds(0.99995), "1 s")
        # A narrow range is widened about its middle.
        low, high = style.widened(1.0, 2.0, 1)
        self.assertAlmostEqual(high / low, 10)
        self.assertAlmostEqual(low * high, 2.0)
        self.assertEqual(style.widened(1.0, 100.0, 1), (1.0, 100.0))

    def test_long_and_odd_names_fit_one_line(self):
        self.assertEqual((names.shown("a\nb"), names.shown("$x$")), ("a b", r"\$x\$"))
        self.assertEqual(len(names.shown("n" * 200)), names.LONGEST)
        self.assertEqual(
            style.short_names(["arkode_erk_4", "arkode_erk_5", "ida"]),
            ["arkode_erk_4", "…_5", "ida"],
        )

    def test_where_in_a_sweep_runs_failed(self):
        sweep = [1e-3, 1e-2, 1e-1, 1]
        for failed, words in (
            (sweep, "every h"), ([1e-1, 1], "h ≥ 0.1"), ([1e-3, 1e-2], "h ≤ 1e-2"),
            ([1e-2], "h = 1e-2"), ([1e-2, 1e-1], "1e-2 ≤ h ≤ 0.1"),
            ([1e-3, 1e-1], "h = 1e-3, 0.1"),
        ):  # fmt: skip
            self.assertEqual(failures.span_in_words(failed, sweep, "h"), words)
        self.assertEqual(failures.span_in_words([1e-3], [1e-3], "h"), "h = 1e-3")
        near_limit = [1e-3, 1.61e-3, 1.62e-3, 1e-2]
        self.assertEqual(failures.span_in_words(near_limit[1:3], near_limit, "h"), "h = 1.6e-3")


class Labels(unittest.TestCase):
    """Placing of labels."""

    BOUNDS = (0, 0, 400, 300)

    def test_labels_at_one_point_keep_off_each_other_and_inside(self):
        size = (60, 12)
        places = labels.place_labels(
            [[(200, 150)]] * 6, [size] * 6, self.BOUNDS, labels.Ink(self.BOUNDS)
        )
        for i, place in enumerate(places):
            for other in places[:i]:
                self.assertFalse(labels.overlap(place.box, other.box))
            x, y = place.center
            self.assertTrue(size[0] / 2 <= x <= 400 - size[0] / 2)
            self.assertTrue(size[1] / 2 <= y <= 300 - size[1] / 2)

    def test_a_label_keeps_off_what_is_drawn(self):
        ink = labels.Ink(self.BOUNDS)
        for x in range(0, 200, labels.CELL):  # all to the left of the anchor is full
            ink.add_line((x, 0), (x, 300))
        (place,) = labels.place_labels([[(204, 150)]], [(60, 12)], self.BOUNDS, ink)
        self.assertGreater(place.box[0], 196)

    def test_crossing_segments(self):
        self.assertTrue(labels.cross((0, 0), (2, 2), (0, 2), (2, 0)))
        self.assertFalse(labels.cross((0, 0), (2, 2), (3, 0), (5, 2)))
        self.assertFalse(labels.cross((0, 0), (1, 1), (0, 3), (3, 0)))
