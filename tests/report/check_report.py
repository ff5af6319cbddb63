"""Whether a folder becomes one page that holds what the files say, and nothing else: made folders
and a real study. The programs are in the folder QDDOT_BIN."""

import math
import os
import subprocess
import unittest

import h5py
import numpy as np
from PIL import Image

import answers
import emphasis
import made_folder
import motion_files
import motion_part
import page
import static_part
from commands import RunCommands
from packed_folder import Folder, elements
from record import read_record
from style import number
from study_folder import read_study
from programs import BIN, Study

SLOW = (
    "symplectic_euler semi_implicit_euler position_verlet blanes_moan4 blanes_moan6 symmetric6"
    " symmetric10 dprkn6 dprkn8"
).split()


class Contents(Folder):
    """The content of a whole folder's page."""

    def test_the_points_and_methods_come_through(self):
        result = self.make(side=3, frames=4, runs=2, scene="a </title> b")
        data, rows = result.data, self.rows()
        points = data["points"]
        for column in ("value", "t_reached", "error_position", "time_s", "energy_growth", "steps"):
            expected = [float(row[column]) if row[column] else None for row in rows]
            self.assertEqual(points[column], expected, column)
        names = [data["methods"][index]["name"] for index in points["method"]]
        self.assertEqual(names, [row["method"] for row in rows])
        for column in ("knob", "outcome"):
            self.assertEqual(points[column], [row[column] for row in rows])
        self.assertEqual({len(column) for column in points.values()}, {len(rows)})
        self.assertTrue(set(data["counts"]) <= set(points))
        for outcome, error, cause in zip(
            points["outcome"], points["error_position"], points["cause"]
        ):
            if outcome == "reached_end":
                self.assertEqual(cause, "error above 3" if error > 3 else None)
            else:
                self.assertRegex(cause, "^the [a-z]+")
        methods = {method["name"]: method for method in data["methods"]}
        titles = {name: data["families"][m["family"]]["title"] for name, m in methods.items()}
        self.assertEqual((titles["verlet"], titles["ida"]), ("hand-written", "SUNDIALS"))
        self.assertEqual(methods["symmetric8"]["line"], "eight, <b>bold</b>")
        # It is one file with all its parts, and the same folder gives the same bytes.
        found = elements(result.text)
        texts = [text for _, _, text in found]
        for text in [*page.scripts(), *map(page.read_source, page.STYLES)]:
            self.assertIn(text, texts)
        self.assertNotRegex(result.text, r"<!-- qddot:|\{\{title\}\}")
        self.assertEqual([text for tag, _, text in found if tag == "title"], ["a </title> b"])
        sources = [attributes["src"] for _, attributes, _ in found if "src" in attributes]
        self.assertEqual([source for source in sources if not source.startswith("data:")], [])
        self.assertEqual(result.text, self.page().text)
        # A study without sentences has the outcomes' own words.
        self.edit("points.json", lambda content: content.pop("outcomes"))
        self.assertIn("diverged", self.page().data["points"]["cause"])

    def test_colours_are_those_of_the_picture_of_the_folder(self):
        made_folder.make_folder(self.folder, has_motions=False)
        rows = self.rows()
        # So many slow methods before the others that some stay pale and take the last colours.
        slow = [row for row in rows if row["method"] == "explicit_euler"]
        slow = [row | {"method": method} for method in SLOW for row in slow]
        methods = self.data_of(slow + rows)["methods"]
        self.assertEqual({method["strong"] for method in methods}, {True, False})
        looks = emphasis.Prominent([read_record(self.folder).judged]).looks
        self.assertEqual(
            {m["name"]: (m["color"], m["marker"]) for m in methods},
            {name: (look.color, look.marker) for name, look in looks.items()},
        )

    def test_the_commands_repeat_the_study_and_its_runs(self):
        made_folder.make_folder(self.folder, has_motions=False)

        def change(content):
            content["command_line"][2] = "my scenes/it's.toml"
            content["study"]["options"] = {
                "--methods": ["verlet", "ida"], "--solver": ["cholmod"],
                "--point-limit": ["0.5", "2"], "--stability-detection": ["true"],
                "--no-reduce": ["mirror", "pins"],
            }  # fmt: skip
            for note in content["methods"]:
                note["takes"] = ["--solver"] if note["name"] == "ida" else []

        self.edit("points.json", change)
        data = self.page().data
        scene = "'my scenes/it'\"'\"'s.toml'"
        line = f"./run report {scene} --methods verlet,ida --solver cholmod --point-limit 2"
        line += " --stability-detection --no-reduce mirror,pins"
        self.assertEqual(data["command"], [line])
        names = [data["methods"][index]["name"] for index in data["points"]["method"]]
        commands = dict(zip(names, data["points"]["command"]))
        of_all = " --until 0.5 --no-reduce mirror,pins"
        for method, words in {
            "verlet": f"--step-size [0-9.e-]+{of_all}$",
            "ida": f"--rtol 1e-11{of_all} --solver cholmod$",
        }.items():
            start = f"build/bin/simulate --scene {scene} --method {method} "
            self.assertRegex(commands[method], start + words)

    def test_all_measured_errors_may_be_chosen(self):
        data = self.make(has_motions=False).data
        rows = self.rows()
        of_column = {one["column"]: one for one in data["quantities"]}
        for column in ("error_position", "error_velocity", "error_energy", "error_energy_max"):
            failures = of_column[column]["failures"]
            drawn = [row[column] for row, why in zip(rows, failures) if why is None]
            shown = [one for one, why in zip(data["points"][column], failures) if why is None]
            self.assertEqual([float(one) for one in drawn], shown, column)
            self.assertGreater(len(shown), 10)
        # Methods are judged by neither of these, and their least error is the reference's own.
        self.assertFalse(any(of_column["error_velocity"]["counts"]))
        self.assertEqual(of_column["error_velocity"]["floor"], 3e-12)
        for row in rows:
            row["error_velocity"] = ""
        columns = [one["column"] for one in self.data_of(rows)["quantities"]]
        self.assertNotIn("error_velocity", columns)
        self.assertIn("error_energy", columns)

    def test_what_an_answer_says(self):
        row = {"accuracy": 1e-2, "point": 3, "runner_up": 5, "ratio": 2.0, "why_empty": None}
        row |= {"others": [{"family": "sundials", "point": 5, "ratio": 2.0}]}
        row |= {"warnings": ["2.9 % below its limit of stability", "doubtful"]}
        found = answers.answer(row)
        self.assertEqual(found["next"], {"point": 5, "ratio": 2.0})
        self.assertEqual(found["others"], [{"family": "SUNDIALS", "point": 5, "ratio": 2.0}])
        self.assertEqual(found["warning"], "2.9 % below its limit of stability; doubtful")
        self.assertEqual(answers.answers_note([found]).count("half"), 1)
        row |= {"point": None, "runner_up": None, "others": [], "warnings": []}
        empty = answers.answer(row | {"why_empty": "no method reached it"})
        self.assertEqual((empty["next"], empty["why"]), (None, "no method reached it"))
        self.assertIsNone(answers.answers_note([empty]))
        found = [static_part.how_long(ratio) for ratio in (1.0, 1.004, 1.04)]
        self.assertEqual(found, ["just as long", "just as long", "1.04 × as long"])


class Motions(Folder):
    """The motions in the page."""

    def test_motions_are_those_of_the_files(self):
        result = self.make(side=5, runs=4)
        data, motion = result.data, result.data["motion"]
        # Nodes that never move are pinned.
        self.assertEqual((motion["nodes"], motion["pinned"]), (25, [0, 5, 10, 15, 20]))
        self.assertEqual([run["role"] for run in motion["runs"]], ["reference"] + 4 * ["run"])
        self.assertIsNone(motion["runs"][0]["distances"])
        for run, row in zip(motion["runs"], self.rows("motions.csv")):
            with h5py.File(self.folder / row["file"]) as file:
                points = np.array(file["VTKHDF/Points"]).reshape(len(run["times"]), -1, 3)
            high = motion["size"] + np.array(motion["low"])
            inside = (points >= motion["low"]) & (points <= high)
            self.assertEqual(run["left_box"], not inside.all())
            # Half a step, and the roundings of positions of about 1 m.
            error = np.abs(result.positions(run) - points)[inside].max()
            self.assertLessEqual(error, motion["size"] / 65535 / 2 + 1e-14)
            point = run["point"]
            name = data["methods"][data["points"]["method"][point]]["name"]
            self.assertEqual(name, row["method"])
            self.assertEqual(data["points"]["value"][point], float(row["value"]))
            self.assertEqual(len(run["energy"]["total"]), int(row["frames"]))
            # The times are those of the frames, and the potential follows.
            self.assertEqual(set(run["energy"]), {"kinetic", "total"})
            if row["outcome"] != "reached_end" or run["distances"] is None:
                continue
            self.assertFalse(run["left_box"])
            largest = result.distances(run).max()
            # A code stands for decades within half of 14 / 254.
            ratio = math.log10(largest / min(1.0, float(row["largest_distance"])))
            self.assertLessEqual(abs(ratio), 14 / 254 / 2 + 1e-6)

    def test_a_run_tells_from_which_frame_each_spring_is_broken(self):
        without = self.make(side=5, runs=2, frames=9).data["motion"]
        first, second, _ = self.rows("motions.csv")
        broken_from = np.full(40, 99)
        broken_from[[3, 17]] = 4, 0
        made_folder.write_strains(self.folder / first["file"], broken_from)
        made_folder.write_strains(self.folder / second["file"], np.full(40, 99))
        result = self.page()
        motion = result.data["motion"]
        told = [run.pop("broken_from", None) for run in motion["runs"]]
        self.assertEqual(told, ["b0", None, None])
        wanted = np.minimum(broken_from, 9).tolist()
        self.assertEqual(np.frombuffer(result.blobs["b0"], "<u4").tolist(), wanted)
        self.assertEqual(motion["notes"], ["Broken springs are not drawn."])
        # All else is as it was; where nothing breaks, the page is the same as without strains.
        self.assertEqual(motion | {"notes": []}, without)
        self.assertNotIn("b1", result.blobs)

    def test_the_frame_of_a_break_is_one_of_the_kept_frames(self):
        made_folder.make_folder(self.folder, side=3, frames=40, runs=1)
        row = self.rows("motions.csv")[0]
        made_folder.write_strains(self.folder / row["file"], np.arange(12) * 4)
        motion = motion_files.open_motion(self.folder, row["file"])
        self.addCleanup(motion.file.close)
        kept = (0, 9, 20, 39)
        wanted = np.searchsorted(kept, np.arange(12) * 4)
        self.assertEqual(motion.broken_from(kept).tolist(), wanted.tolist())
        self.assertIsNone(motion.broken_from((0,)[1:]))

    def test_energies_have_the_digits_that_are_shown(self):
        self.folder.mkdir()
        (self.folder / "motions_energy.csv").write_text(
            "file,t,kinetic,potential,total\na,0.012345678901,2.3456789012e-5,-1.2345678901,"
            "0.12345678901234567\na,0.5,nan,,inf\n"
        )
        found = motion_files.read_energies(self.folder)["a"]
        self.assertEqual((found["t"], found["kinetic"]), ([0.01234568, 0.5], [2.345679e-5, None]))
        self.assertEqual(found["potential"], [-1.234568, None])
        self.assertEqual(found["total"], [0.12345678901234567, None])

    def test_energies_of_damped_motions_have_what_damping_took(self):
        self.folder.mkdir()
        table = self.folder / "motions_energy.csv"
        table.write_text("file,t,kinetic,potential,total,dissipated\na,0,1,2,3,0\na,1,1,1,2,1.01\n")
        found = motion_files.read_energies(self.folder)["a"]
        self.assertEqual(found["dissipated"], [0, 1.01])
        told = motion_part.told_energy(found, [0, 1])
        self.assertEqual(told, {"kinetic": [1, 1], "total": [3, 2], "dissipated": [0, 1.01]})

    def test_energies_of_driven_motions_have_what_driving_gave(self):
        self.folder.mkdir()
        table = self.folder / "motions_energy.csv"
        table.write_text("file,t,kinetic,potential,total,driven\na,0,1,2,3,0\na,1,1,1,2,-1.01\n")
        found = motion_files.read_energies(self.folder)["a"]
        self.assertEqual(found["driven"], [0, -1.01])
        told = motion_part.told_energy(found, [0, 1])
        self.assertEqual(told, {"kinetic": [1, 1], "total": [3, 2], "driven": [0, -1.01]})

    def test_upwards_is_against_gravity(self):
        self.make(side=3, frames=3, runs=1)
        for gravity, up in (
            ([0, -9.81, 0], [0, 1, 0]), ([0, -9.81], [0, 1, 0]), ([3], [-1, 0, 0]),
            ([0, 0, 0], None), (None, None), ("down", None), ([0, None, 1], None),
        ):  # fmt: skip
            self.edit("points.json", lambda content: content["scene"].update(gravity=gravity))
            self.assertEqual(self.page().data["motion"]["up"], up, gravity)

    def test_one_mass_has_a_phase_plane(self):
        # The first of two nodes stays.
        for dimension in (1, 2):
            motion = self.make(side=2, dimension=dimension, runs=2).data["motion"]
            for run, row in zip(motion["runs"], self.rows("motions.csv")):
                with h5py.File(self.folder / row["file"]) as file:
                    rows = {
                        "position": np.array(file["VTKHDF/Points"])[1::2],
                        "velocity": np.array(file["VTKHDF/PointData/velocity"])[1::2],
                    }
                for name, wanted in rows.items():
                    found = np.array(run["phase"][name])
                    self.assertEqual(found.shape, (dimension, len(run["times"])))
                    # Five digits.
                    np.testing.assert_allclose(found, wanted.T[:dimension], rtol=5e-5)
        runs = self.make(side=3, dimension=2, runs=2).data["motion"]["runs"]
        self.assertNotIn("phase", runs[0])

    def test_scenes_of_fewer_dimensions_and_parts(self):
        result = self.make(side=3, runs=2)
        springs = np.frombuffer(result.blobs["s0"], "<u4").reshape(-1, 2)
        faces = np.frombuffer(result.blobs["f0"], "<u4").reshape(-1, 3)
        self.assertEqual((springs[0].tolist(), len(springs)), ([0, 1], 12))
        self.assertEqual((faces[0].tolist(), len(faces)), ([0, 1, 3], 8))
        for dimension in (1, 2):
            motion = self.make(dimension=dimension, runs=2).data["motion"]
            self.assertEqual((motion["dimension"], motion["faces"]), (dimension, None))
        result = self.make(side=3, has_springs=False, has_faces=False, runs=2)
        self.assertEqual((result.blobs["s0"], result.data["motion"]["faces"]), (b"", None))
        motion = self.make(side=1, frames=1, runs=0, dimension=1).data["motion"]
        self.assertEqual((motion["nodes"], motion["pinned"]), (1, []))
        self.assertGreater(motion["size"], 0)

    def test_ten_thousand_nodes_stay_below_eight_megabytes(self):
        data = self.make(side=100, frames=30, runs=14).data
        self.assertLessEqual(os.path.getsize(self.folder / "report.html"), 8_000_000)
        runs = data["motion"]["runs"]
        self.assertEqual(runs[0]["role"], "reference")
        self.assertEqual((runs[0]["times"][0], runs[0]["times"][-1]), (0, 0.5))
        self.assertTrue(1 < len(runs) < 15)
        said = r"holds \d+ of the 15 motions .* files in motions/"
        self.assertRegex(" ".join(data["motion"]["notes"]), said)

    def test_a_run_of_seconds_by_phase(self):
        made_folder.make_folder(self.folder, side=3, frames=4, runs=1)
        rows = self.rows("motions.csv")
        phases = ("force", "stiffness", "factorization", "solve")
        names = ["seconds", *(f"seconds_{phase}" for phase in phases)]
        rows[0] |= dict.fromkeys(names, "")
        rows[1] |= dict(zip(names, ("2", "0.5", "", "0.25", "0")))
        self.rewrite("motions.csv", rows)
        first, second = self.page().data["motion"]["runs"]
        self.assertIsNone(first["seconds"])
        self.assertEqual(second["seconds"], {"all": 2} | dict(zip(phases, (0.5, None, 0.25, 0))))


class BeyondTheHorizon(Folder):
    """A folder whose end is beyond the horizon of a chaotic motion."""

    def setUp(self):
        super().setUp()
        made_folder.make_folder(self.folder, has_motions=False)
        known = {"beyond_horizon": True, "horizon": 0.3, "lyapunov": 50.0, "chaotic": True}
        known |= {"modal_shares_floor": 0.01}
        self.edit("reference.json", lambda content: content.update(known))

    def test_energy_judges(self):
        rows = [row for row in self.rows() if row["outcome"] == "reached_end"]
        for row in rows:
            row |= {"error_position": 9, "error_position_at_least": 9, "error_position_at_most": 9}
        for row, error in zip(rows, (1e-5, 4, "")):
            row |= {"error_energy_max": error, "error_modal_shares": 0.01}
        data = self.data_of(rows)
        self.assertEqual(data["judged_by"], "energy")
        self.assertEqual(data["quantities"][0]["column"], "error_energy_max")
        self.assertRegex(data["notes"][0], "^Chaotic: from t = 0.3 s on.*")
        self.assertNotIn("\n", data["notes"][0])
        expected = [None, "error above 3", "error not measured"]
        self.assertEqual(data["points"]["cause"][:3], expected)
        self.assertIsNotNone(data["answers"][0]["point"])
        self.assertNotIn("No run gave a point.", data["notes"])
        for row in rows:
            row |= {"error_position": 1e-3, "error_energy_max": 4}
        self.assertIn("No run gave a point.", self.data_of(rows)["notes"])

    def test_another_motion_is_no_answer(self):
        rows = self.rows()
        for row in rows:
            # Chance makes 0.01; ten times as far is another motion.
            row["error_modal_shares"] = 0.11 if row["method"] == "symmetric8" else 0.09
        data = self.data_of(rows)
        names = [data["methods"][index]["name"] for index in data["points"]["method"]]
        fastest = {names[answer["point"]] for answer in data["answers"] if answer["point"]}
        self.assertTrue(fastest)
        self.assertNotIn("symmetric8", fastest)
        counts = data["quantities"][0]["counts"]
        self.assertEqual(counts, [name != "symmetric8" for name in names])


class Luck(Folder):
    """A folder with a run whose error is small by luck."""

    def test_a_lucky_run_is_no_answer_and_tells_where_it_counts(self):
        made_folder.make_folder(self.folder, has_motions=False)
        rows = [row for row in self.rows() if row["outcome"] == "reached_end"]
        name = rows[0]["method"]
        own = [row for row in rows if row["method"] == name]
        own.sort(key=lambda row: -float(row["value"]))
        for row, error in zip(own, (1e-8, 0.6, *[0.5] * len(own))):
            row |= {"error_position": error, "time_s": 1e-9}
        data = self.data_of(rows)
        lucky = data["quantities"][0]["lucky"]
        self.assertEqual({str(rows.index(own[0])): 0.6}, {at: round(e, 6) for at, e in lucky.items()})
        names = [data["methods"][index]["name"] for index in data["points"]["method"]]
        fastest = {names[answer["point"]] for answer in data["answers"] if answer["point"]}
        self.assertNotIn(name, fastest)


class WithoutScripts(Folder):
    """The page where no scripts run."""

    def test_the_answers_and_the_chart_stand_there(self):
        made_folder.make_folder(self.folder, has_motions=False)
        Image.new("RGB", (2000, 10), "white").save(self.folder / "chart.png")
        result = self.page()
        data, found = result.data, elements(result.text)
        # The table with scripts has a head of its own.
        columns = sum(tag == "th" and "scope" not in of for tag, of, _ in found)
        cells = [text for tag, _, text in found if tag == "td"]
        rows = [cells[start : start + columns] for start in range(0, len(cells), columns)]
        # A run that is the fastest at several accuracies has one row.
        groups = answers.runs_of_answers(data["answers"])
        self.assertTrue(1 < len(groups) < len(data["answers"]))
        ends = [(number(group[0]["accuracy"]), number(group[-1]["accuracy"])) for group in groups]
        self.assertEqual([row[0] for row in rows], [" to ".join(dict.fromkeys(e)) for e in ends])
        points = [group[0]["point"] for group in groups]
        self.assertTrue(all(a != b for a, b in zip(points, points[1:])))
        for row, (answer, *_) in zip(rows, groups):
            value = data["points"]["value"][answer["point"]]
            self.assertEqual(float(row[2].split()[2]), float(f"{value:.4g}"))
            self.assertEqual(row[-1], answer["warning"] or "")
        said = " ".join(row[-1] for row in rows)
        self.assertRegex(said, "% (below|above) its limit of stability")
        texts = [text for tag, _, text in found if tag == "p"]
        self.assertEqual(texts.count(data["answers_note"]), 1)
        ((_, attributes, _),) = [one for one in found if one[0] == "img"]
        self.assertEqual(attributes["style"], "max-width:100%")
        # Without a margin there is no note on margins.
        (self.folder / "front.csv").unlink()
        result = self.page()
        self.assertIsNone(result.data["answers_note"])
        self.assertNotIn("limit of stability", result.text)


class Modules(unittest.TestCase):
    """The scripts and styles of the page."""

    def test_every_file_is_packed_and_every_import_is_exported_once(self):
        known = set()
        for script in page.SCRIPTS:
            page.with_imports(script, known)
        own = [file.relative_to(page.HOME) for file in (page.HOME / "page").rglob("*.[jc]s*")]
        packed = [name for name in [*known, *page.STYLES] if name.startswith("page/")]
        self.assertEqual(sorted(map(str, own)), sorted(packed))
        modules = {file.name: file.read_text() for file in (page.HOME / "page/js").iterdir()}
        exported = {
            name: [found[1] for found in page.EXPORT.findall(text)]
            for name, text in modules.items()
        }
        every = sorted(sum(exported.values(), []))
        self.assertEqual(every, sorted(set(every)))
        for name, text in modules.items():
            for names, file in page.IMPORT.findall(text):
                wanted = {one.strip() for one in names.split(",")} - {""}
                self.assertLessEqual(wanted, set(exported[file]), f"{name} from {file}")


class RealStudy(unittest.TestCase):
    """A study with options of its own."""

    def test_simulate_takes_the_commands_of_the_runs(self):
        # Runs that take longer are points without an error; which ones, decides nothing here.
        words = "work_precision --scene orbit --methods verlet,cvode_bdf,implicit_midpoint"
        words += " --until 0.5 --repeats 1 --max-order 3 --solver cholmod --accuracies 0.03"
        words += " --point-limit 0.02 --out own"
        made = Study(words)
        study = read_study(made / "own")
        (answer,), (row,) = answers.answers(study), made.table("own/front.csv")
        self.assertEqual((answer["accuracy"], row["accuracy"]), (0.03, 0.03))
        self.assertEqual(study.runs[answer["point"]].method, row["method"])
        failed = {run.outcome for run in study.runs} - {"reached_end"}
        self.assertEqual(failed, set(study.sidecar["outcomes"]))
        self.assertEqual({run.method for run in study.runs}, set(study.method_notes))
        for method, option in (
            ("verlet", ""), ("cvode_bdf", " --max-order 3"),
            ("implicit_midpoint", " --solver cholmod"),
        ):  # fmt: skip
            run = next(r for r in study.runs if r.method == method and r.outcome == "reached_end")
            line = RunCommands(study).of_run(run.method, run.knob, run.value)
            self.assertIn(option, line)
            self.assertEqual("--solver" in line, method != "verlet")
            line = line.replace("build/bin", BIN, 1)
            done = subprocess.run(line, shell=True, cwd=made.path, capture_output=True, check=False)
            self.assertEqual(done.returncode, 0, f"{line}: {done.stderr}")
