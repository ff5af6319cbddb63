#include "qddot/model/kernels/roots.hpp"
#include "qddot/model/kernels/spring_kernels.hpp"
#include "tests/programs/sweeps.hpp"

BOOST_AUTO_TEST_SUITE(sweep_faults)

using namespace qddot;
using kit::Journal;

namespace {

// A sweep that is whole, but whose chain's Verlet was measured on another kind of machine.
struct OnTwoMachines : Sweep {
  OnTwoMachines() {
    go("references");
    go("points");
    rewrite(task("chain", "verlet"), [](Journal::Contents& contents) {
      contents.key["machine"]["cpu"] = "another processor";
    });
  }
};

std::set<std::string> column(const Table& table, const std::string& name) {
  std::set<std::string> values;
  for (std::size_t row = 0; row < table.rows.size(); ++row) values.insert(table.text(row, name));
  return values;
}

// Roots that this processor has beside its own; its own where it has no others.
std::string other_roots() {
  std::string_view last;
  for (int i = 0; i < kernels::kinds_of_roots; ++i) {
    if (kernels::spring_kernels(3, static_cast<kernels::Roots>(i)))
      last = kernels::names_of_roots()[i];
  }
  return std::string(last);
}

// Does the work while processes are told to take these roots.
void with_roots(const std::string& roots, const std::function<void()>& work) {
  setenv("QDDOT_ROOTS", roots.c_str(), 1);
  work();
  unsetenv("QDDOT_ROOTS");
}

}  // namespace

BOOST_AUTO_TEST_CASE(seconds_of_unlike_machines_are_never_put_on_one_front) {
  const OnTwoMachines sweep;
  const Exit refused = sweep.merge();
  BOOST_TEST(complains(refused, 2, "sweep",
                       {"another processor (1 tasks)", "(7 tasks)", "--per-machine", "--by work"}),
             refused.err);
  BOOST_TEST(!std::filesystem::exists(sweep.out + "/points.csv"));
  BOOST_TEST(contains(run("sweep", {"status", sweep.out}).out,
                      {"measured on unlike machines", "another processor"}));

  const Exit apart = sweep.merge({"--per-machine", "--no-pictures"});
  BOOST_TEST(apart.status == 0, apart.err);
  const std::set<std::string> first =
                                  column(read_csv(sweep.out + "/machines/1/points.csv"), "method"),
                              second =
                                  column(read_csv(sweep.out + "/machines/2/points.csv"), "method");
  BOOST_TEST((first == std::set<std::string>{"blanes_moan4", "ida", "implicit_euler", "verlet"}));
  BOOST_TEST((second == std::set<std::string>{"verlet"}));
  BOOST_TEST(
      contains(read_all(sweep.out + "/machines/2/chain/points.json"), {"another processor"}));
}

BOOST_AUTO_TEST_CASE(what_other_machines_measured_is_measured_again_where_that_is_asked_for) {
  const OnTwoMachines sweep;
  const auto before = sweep.measured();
  BOOST_TEST(sweep.go("points").status == 0);
  BOOST_TEST((sweep.measured() == before));
  BOOST_TEST(sweep.go("points", {"--again"}).status == 0);
  const auto after = sweep.measured();
  std::size_t changed = 0;
  for (const auto& [name, bytes] : before) changed += after.at(name) != bytes;
  BOOST_TEST(changed == 1u);
  check_as_one_process(sweep);
}

BOOST_AUTO_TEST_CASE(by_work_times_are_counts_times_costs_on_this_machine) {
  const OnTwoMachines sweep;
  const Exit merged = sweep.merge({"--by", "work", "--no-pictures"});
  BOOST_TEST(merged.status == 0, merged.err);
  const auto costs = nlohmann::json::parse(read_all(sweep.out + "/chain/costs.json")).at("seconds");
  BOOST_TEST(costs.at("force").get<double>() > 0);
  BOOST_TEST(costs.at("factorization").get<double>() > 0);
  const Table points = read_csv(sweep.out + "/chain/points.csv");
  for (std::size_t row = 0; row < points.rows.size(); ++row) {
    if (points.text(row, "outcome") != "reached_end") continue;
    double work = 0;
    for (const auto& [column, cost] : {std::pair("force_evaluations", "force"),
                                       {"stiffness_evaluations", "stiffness"},
                                       {"factorizations", "factorization"},
                                       {"solves", "solve"}})
      work += points.value(row, column) * costs.at(cost).get<double>();
    // Four products and sums.
    BOOST_TEST(points.value(row, "time_s") == work, boost::test_tools::tolerance(1e-15));
  }
  BOOST_TEST(contains(read_all(sweep.out + "/sweep.json"), {"\"times\": \"work\""}));
  // Errors and counts stay those that were measured, and costs are not measured twice.
  BOOST_TEST((untimed_points(sweep.out + "/points.csv") == points_of_one_process()));
  const std::string kept = read_all(sweep.out + "/chain/costs.json");
  sweep.merge({"--by", "work", "--no-pictures"});
  BOOST_TEST(read_all(sweep.out + "/chain/costs.json") == kept);
}

// Each process chooses the fastest roots by a measurement of its own, so two may differ.
BOOST_AUTO_TEST_CASE(processes_with_unlike_roots_measure_one_study) {
  const std::string other = other_roots();
  const Sweep sweep;
  with_roots("processor", [&] { BOOST_TEST(sweep.go("references").status == 0); });
  with_roots(other, [&] {
    const std::string id = sweep.task("chain", "verlet").at("id");
    const Exit first = sweep.go("points", {"--task", id});
    BOOST_TEST(first.status == 0, first.err);
  });
  with_roots("processor", [&] {
    const auto before = sweep.measured();
    const Exit rest = sweep.go("points", {"--again"});  // nothing is of another machine
    BOOST_TEST(rest.status == 0, rest.err);
    const auto after = sweep.measured();
    for (const auto& [name, bytes] : before) BOOST_TEST((after.at(name) == bytes));
  });
  check_as_one_process(sweep);
  std::string used;
  for (const std::string& name : std::set<std::string>{"processor", other})
    used += (used.empty() ? "" : ", ") + name;
  const auto sidecar = nlohmann::json::parse(read_all(sweep.out + "/chain/points.json"));
  BOOST_TEST(sidecar.at("roots") == used);
}

BOOST_AUTO_TEST_CASE(a_study_that_is_complete_is_so_with_other_roots) {
  const Folder folder;
  const auto resume = [&] {
    return run("convergence", {"--scene", "pendulum", "--until", "0.05", "--methods", "verlet",
                               "--out", folder.path(), "--resume"});
  };
  with_roots(other_roots(), [&] { BOOST_TEST(resume().status == 0); });
  with_roots("processor", [&] { BOOST_TEST(contains(resume().err, {"nothing is missing"})); });
}

BOOST_AUTO_TEST_CASE(a_task_that_other_code_measured_does_not_count) {
  const Sweep sweep;
  sweep.go("references");
  sweep.go("points");
  sweep.rewrite(sweep.task("chain", "ida"),
                [](Journal::Contents& contents) { contents.key["build"]["code"] = "other"; });
  const Exit merged = sweep.merge();
  BOOST_TEST(merged.status == 3);
  BOOST_TEST(contains(merged.out, {"chain, ida: missing"}));
  BOOST_TEST(!column(read_csv(sweep.out + "/chain/points.csv"), "method").contains("ida"));
  BOOST_TEST(sweep.go("points").status == 0);
  check_as_one_process(sweep);
}

BOOST_AUTO_TEST_CASE(a_plan_of_another_build_is_refused) {
  const Sweep sweep;
  std::string text;
  for (nlohmann::json task : sweep.tasks()) {
    task["key"]["build"]["flags"] = "-O0";
    text += task.dump() + "\n";
  }
  // A key that was changed by hand does not fit its id.
  std::ofstream(sweep.out + "/tasks.jsonl") << text;
  Exit end = sweep.go("points");
  BOOST_TEST(complains(end, 2, "sweep", {"tasks.jsonl:1: it is no task as sweep plan writes it"}),
             end.err);
  for (const char* damage : {"", "{", "[1]\n", "{\"id\": 3}\n"}) {
    std::ofstream(sweep.out + "/tasks.jsonl") << damage;
    end = sweep.merge();
    BOOST_TEST(complains(end, 2, "sweep", {"tasks.jsonl"}), end.err);
  }
}

BOOST_AUTO_TEST_CASE(a_scene_without_a_reference_is_skipped_and_the_rest_goes_on) {
  const Sweep sweep(R"(scenes = ["pendulum", { file = "late.toml" }]
methods = ["verlet"]
until = 0.05
accuracies = [1e-2]
[options]
repeats = 1
)");
  BOOST_TEST(sweep.planned.status == 2);  // the file is missing
  const Sweep late(R"(scenes = [{ generator = "pendulum", until = [0.05, 1e9] }]
methods = ["verlet"]
accuracies = [1e-2]
[options]
repeats = 1
)");
  BOOST_TEST(late.go("references").status == 0);  // that there is none is known now
  const Exit points = late.go("points");
  BOOST_TEST(points.status == 0, points.err);
  BOOST_TEST(contains(points.out, {"1 of 2 tasks are done, 1 are skipped"}), points.out);
  const Exit merged = late.merge();
  BOOST_TEST(merged.status == 3);
  const Table missing = read_csv(late.out + "/missing.csv");
  BOOST_TEST_REQUIRE(missing.rows.size() == 2u);
  BOOST_TEST(missing.text(0, "state") == "no reference");
  BOOST_TEST(contains(missing.text(0, "cause"), {"earlier end (--until)"}));
  BOOST_TEST(missing.text(1, "state") == "skipped");
  BOOST_TEST(read_csv(late.out + "/fastest.csv").rows.size() == 1u);
  BOOST_TEST(contains(run("sweep", {"status", late.out}).out,
                      {"1 without a reference", "1 tasks are skipped", "all is done"}));
}

BOOST_AUTO_TEST_CASE(points_wait_for_their_reference) {
  const Sweep sweep;
  const Exit end = sweep.go("points");
  BOOST_TEST(end.status == 3);
  BOOST_TEST(contains(end.out, {"0 of 8 tasks are done, 8 wait for a reference"}));
  BOOST_TEST(sweep.measured().empty());
}

BOOST_AUTO_TEST_CASE(what_failed_is_listed_with_its_cause_and_a_command_that_measures_it) {
  const Folder folder;
  const std::string scene = folder.write("mine.toml", "[generator]\nkind = \"orbit\"\n");
  const Sweep sweep(
      fmt::format("scenes = [\"{}\"]\nuntil = 0.05\nmethods = [\"verlet\"]\n"
                  "accuracies = [1e-2]\n[options]\nrepeats = 1\n",
                  scene));
  sweep.go("references");
  folder.write("mine.toml", "[generator]\nkind = \"orbit\"\nmass = 2\n");
  const Exit changed = sweep.go("points");
  BOOST_TEST(changed.status == 3);
  BOOST_TEST(contains(changed.err, {"mine, verlet", "its scene is", "instead of"}), changed.err);
  BOOST_TEST(
      contains(run("sweep", {"status", sweep.out}).out, {"failed: mine, verlet", "1 failed"}));
  BOOST_TEST(sweep.merge().status == 3);
  const Table missing = read_csv(sweep.out + "/missing.csv");
  BOOST_TEST_REQUIRE(missing.rows.size() == 1u);
  BOOST_TEST(missing.text(0, "state") == "failed");
  BOOST_TEST(contains(missing.text(0, "cause"), {"its scene is"}));
  folder.write("mine.toml", "[generator]\nkind = \"orbit\"\n");
  BOOST_TEST(std::system((missing.text(0, "command") + " >/dev/null").c_str()) == 0);
  BOOST_TEST(sweep.merge().status == 0);
}

BOOST_AUTO_TEST_CASE(a_reference_that_is_gone_is_made_again) {
  const Sweep sweep;
  sweep.go("references");
  std::filesystem::remove(sweep.out + "/chain/reference.json");
  std::filesystem::copy_file(sweep.out + "/pendulum/reference.json",
                             sweep.out + "/chain/reference.json");
  BOOST_TEST(contains(sweep.go("points").out, {"4 of 8 tasks are done, 4 wait for a reference"}));
  BOOST_TEST(sweep.go("references").status == 0);
  BOOST_TEST(sweep.go("points").status == 0);
  check_as_one_process(sweep);
}

BOOST_AUTO_TEST_CASE(a_damaged_file_is_measured_anew) {
  const Sweep sweep;
  sweep.go("references");
  sweep.go("points");
  const auto task = sweep.task("pendulum", "ida");
  std::filesystem::resize_file(sweep.whole(task),
                               std::filesystem::file_size(sweep.whole(task)) - 3);
  BOOST_TEST(contains(run("sweep", {"status", sweep.out}).out, {"7 done, 1 not begun"}));
  BOOST_TEST(sweep.go("points").status == 0);
  check_as_one_process(sweep);
}

BOOST_AUTO_TEST_CASE(a_full_disk_is_said_and_nothing_is_half_written) {
  const Sweep sweep;
  sweep.go("references");
  // Files may grow to 1 kB, except for the one with messages.
  const int status = std::system(
      fmt::format("bash -c '(ulimit -f 1; exec {}/sweep run {} --stage points) 2>&1 >/dev/null | "
                  "cat >{}; exit ${{PIPESTATUS[0]}}'",
                  PROGRAM_FOLDER, sweep.out, sweep.folder / "said")
          .c_str());
  BOOST_TEST(WEXITSTATUS(status) == 3);
  BOOST_TEST(contains(read_all(sweep.folder / "said"), {"cannot be written"}));
  BOOST_TEST(sweep.measured().size() == 2u);
  // If not even that can be said, it ends in order all the same.
  const int silent =
      std::system(fmt::format("bash -c 'exec 2>{}; ulimit -f 0; exec {}/sweep run {} "
                              "--stage points >/dev/null'",
                              sweep.folder / "silent", PROGRAM_FOLDER, sweep.out)
                      .c_str());
  BOOST_TEST(WEXITSTATUS(silent) == 3);
  BOOST_TEST(sweep.go("points").status == 0);
  check_as_one_process(sweep);
}

BOOST_AUTO_TEST_CASE(lines_for_slurm_and_parallel_hold_what_was_asked_for) {
  const Sweep sweep;
  const Exit slurm = run("sweep", {"submit", sweep.out, "--slurm", "--partition=short", "--time",
                                   "2:00:00", "--shards", "5"});
  BOOST_TEST(slurm.status == 0, slurm.err);
  const std::string& lines = slurm.out;
  BOOST_TEST(std::ranges::count(lines, '\n') == 3);
  BOOST_TEST(contains(lines, {"references=$(sbatch ", "--array=1-2 ", "points=$(sbatch ",
                              "--array=1-5 ", "--dependency=afterok:\"$references\"",
                              "merge=$(sbatch ", "--dependency=afterany:\"$points\"",
                              "--threads-per-core=1", "--partition=short --time 2:00:00 --wrap=",
                              "--shard \"$SLURM_ARRAY_TASK_ID/5\""}),
             lines);
  const Exit parallel = run("sweep", {"submit", sweep.out, "--parallel", "--sshlogin", "a,b"});
  BOOST_TEST(parallel.status == 0, parallel.err);
  BOOST_TEST(contains(parallel.out, {"seq 2 | parallel ", "seq 8 | parallel ", "--sshlogin a,b ",
                                     "--shard {}/8", "merge"}),
             parallel.out);
}

BOOST_AUTO_TEST_CASE(parallel_runs_its_lines_where_it_is_installed) {
  if (std::system("command -v parallel >/dev/null") != 0) {
    BOOST_TEST_MESSAGE("GNU parallel is not installed");
    return;
  }
  const Sweep sweep;
  const Exit end = run("sweep", {"submit", sweep.out, "--parallel", "--go", "--shards", "3"});
  BOOST_TEST(end.status == 0, end.err);
  BOOST_TEST((untimed_points(sweep.out + "/points.csv") == points_of_one_process()));
  BOOST_TEST(std::filesystem::exists(sweep.out + "/fastest.png"));
  BOOST_TEST(std::filesystem::exists(sweep.out + "/chain/report.html"));
}

BOOST_AUTO_TEST_SUITE_END()
