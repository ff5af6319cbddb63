#include <csignal>
#include <thread>

#include "tests/programs/sweeps.hpp"

BOOST_AUTO_TEST_SUITE(sweep_tasks)

using namespace qddot;
using kit::Journal;

BOOST_AUTO_TEST_CASE(a_plan_has_references_first_and_a_task_for_each_method_of_each_scene) {
  const Sweep sweep;
  BOOST_TEST(sweep.planned.status == 0, sweep.planned.err);
  BOOST_TEST(contains(sweep.planned.out, {"2 scenes, 2 references, 8 tasks of points"}));
  const auto tasks = sweep.tasks();
  BOOST_TEST_REQUIRE(tasks.size() == 10u);
  std::set<std::string> ids;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    BOOST_TEST((tasks[i].at("stage") == (i < 2 ? "references" : "points")));
    BOOST_TEST((tasks[i].at("share") == "reference") == (i < 2));
    ids.insert(tasks[i].at("id"));
  }
  BOOST_TEST(ids.size() == tasks.size());
}

BOOST_AUTO_TEST_CASE(a_task_is_named_by_all_that_decides_what_it_measures_and_by_nothing_else) {
  const Sweep first;
  const Sweep same;
  BOOST_TEST(first.tasks() != same.tasks());  // the chain's file is in another folder
  const auto id_with = [](const std::string& from, const std::string& to) {
    std::string text = small_study;
    text.replace(text.find(from), from.size(), to);
    return Sweep(text).task("chain", "verlet").at("id");
  };
  const auto id = first.task("chain", "verlet").at("id");
  BOOST_TEST(same.task("chain", "verlet").at("id") == id);
  BOOST_TEST(id_with("\"ida\"", "\"ida\", \"rk4\"") == id);
  BOOST_TEST(id_with("\"pendulum\"", "\"orbit\"") == id);
  BOOST_TEST(id_with("nodes = 6", "nodes = 7") != id);
  BOOST_TEST(id_with("until = 0.05", "until = 0.06") != id);
  BOOST_TEST(id_with("1e-4", "1e-5") != id);
  BOOST_TEST(id_with("repeats = 1", "repeats = 2") != id);
  BOOST_TEST(first.task("chain", "ida").at("id") != id);
  BOOST_TEST(first.task("pendulum", "verlet").at("id") != id);
}

BOOST_AUTO_TEST_CASE(methods_that_cannot_run_a_scene_are_left_out_of_it_alone) {
  const Sweep sweep(
      "scenes = [\"oscillator\", \"pendulum\"]\nuntil = 0.1\n"
      "methods = [\"exact\", \"verlet\"]\n");
  BOOST_TEST(sweep.planned.status == 0, sweep.planned.err);
  std::set<std::string> shares;
  for (const auto& task : sweep.tasks()) {
    if (task.at("stage") == "points")
      shares.insert(fmt::format("{} {}", task.at("folder").get<std::string>(),
                                task.at("share").get<std::string>()));
  }
  BOOST_TEST((shares ==
              std::set<std::string>{"oscillator exact", "oscillator verlet", "pendulum verlet"}));
  const Sweep none("scenes = [\"pendulum\"]\nmethods = [\"exact\"]\n");
  BOOST_TEST(complains(none.planned, 2, "sweep", {"pendulum", "exact needs a K"}),
             none.planned.err);
}

BOOST_AUTO_TEST_CASE(shards_measure_the_points_of_one_process) {
  const Sweep sweep;
  BOOST_TEST(sweep.go("references").status == 0);
  for (const char* shard : {"3/3", "1/3", "2/3"}) {
    const Exit end = sweep.go("points", {"--shard", shard});
    BOOST_TEST(end.status == 0, end.err);
  }
  const Exit merged = sweep.merge();
  BOOST_TEST(merged.status == 0, merged.err);
  BOOST_TEST((untimed_points(sweep.out + "/points.csv") == points_of_one_process()));
  BOOST_TEST(read_csv(sweep.out + "/missing.csv").rows.empty());
  BOOST_TEST(listing(sweep.out + "/tasks/begun") == "");
  for (const char* scene : {"pendulum", "chain"}) {
    const Table front = read_csv(fmt::format("{}/{}/front.csv", sweep.out, scene));
    BOOST_TEST(front.rows.size() == 2u);  // the accuracies that were asked for
  }
}

BOOST_AUTO_TEST_CASE(tables_say_how_one_process_would_make_them) {
  const Sweep sweep;
  BOOST_TEST(sweep.go_and_merge().status == 0);
  const auto sidecar = nlohmann::json::parse(read_all(sweep.out + "/pendulum/points.json"));
  const std::vector<std::string> words = sidecar.at("command_line");
  BOOST_TEST((std::ranges::find(words, "--kept") == words.end()));
  // So it is a complete study, which --resume finds to be one.
  std::vector<std::string> again(words.begin() + 1, words.end());
  again.emplace_back("--resume");
  const Exit end = run("work_precision", again);
  BOOST_TEST(end.status == 0, end.err);
  BOOST_TEST(contains(end.err, {"nothing is missing"}), end.err);
}

BOOST_AUTO_TEST_CASE(what_is_done_is_never_measured_again) {
  const Sweep sweep;
  sweep.go("references");
  sweep.go("points", {"--shard", "1/2"});
  const auto before = sweep.measured();
  BOOST_TEST(before.size() == 6u);
  const Exit rest = sweep.go("points");
  BOOST_TEST(contains(rest.out, {"8 of 8 tasks are done"}));
  BOOST_TEST(sweep.go("references").status == 0);
  const auto after = sweep.measured();
  BOOST_TEST(after.size() == 10u);
  for (const auto& [name, bytes] : before) BOOST_TEST((after.at(name) == bytes), name);
  // Nor where the study grows.
  std::string larger = small_study;
  larger.replace(larger.find("\"ida\""), 5, "\"ida\", \"rk4\"");
  sweep.folder.write("study.toml", larger);
  const Exit planned = run("sweep", {"plan", sweep.study, "--out", sweep.out});
  BOOST_TEST(contains(planned.out, {"10 tasks of points; 10 of these are measured already"}),
             planned.out);
  sweep.go("points");
  const auto grown = sweep.measured();
  BOOST_TEST(grown.size() == 12u);
  for (const auto& [name, bytes] : after) BOOST_TEST((grown.at(name) == bytes), name);
}

BOOST_AUTO_TEST_CASE(killed_at_any_moment_it_loses_nothing_that_was_measured) {
  const Sweep sweep;
  int kills = 0;
  for (const char* stage : {"references", "points"}) {
    for (int milliseconds = 5;; milliseconds = milliseconds * 5 / 4) {
      const auto before = sweep.measured();
      Started process("sweep", {"run", sweep.out, "--stage", stage});
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      const Exit end = process.end(SIGKILL);
      for (const auto& [name, bytes] : before) {
        const auto after = sweep.measured();
        BOOST_TEST_REQUIRE(after.contains(name));
        BOOST_TEST((after.at(name) == bytes));
      }
      if (end.status == 0) break;
      BOOST_TEST(end.status == 128 + SIGKILL);
      ++kills;
    }
  }
  BOOST_TEST(kills > 5);
  check_as_one_process(sweep);
}

BOOST_AUTO_TEST_CASE(what_it_runs_ends_with_it) {
  const Sweep sweep(
      "scenes = [{ generator = \"chain\", stiffness = 1e9 }]\n"
      "methods = [\"explicit_euler\"]\n[options]\npoint-limit = 60\n");
  sweep.go("references");
  Started process("sweep", {"run", sweep.out, "--stage", "points"});
  const auto says = [&](const char* what) {
    return contains(run("sweep", {"status", sweep.out}).out, {what});
  };
  // Its runs take minutes.
  for (int i = 0; i < 12000 && !says("1 running"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  BOOST_TEST_REQUIRE(says("1 running"));
  process.end(SIGKILL);
  for (int i = 0; i < 12000 && says("1 running"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  BOOST_TEST(!says("1 running"));
}

BOOST_AUTO_TEST_CASE(points_of_a_task_that_was_killed_are_kept) {
  const Sweep sweep;
  sweep.go("references");
  sweep.go("points");
  // As if a process had been killed after its first point.
  const auto task = sweep.task("chain", "verlet");
  auto contents = Journal::read(sweep.whole(task));
  std::filesystem::remove(sweep.whole(task));
  const std::string begun = fmt::format("{}/tasks/begun/{}.elsewhere.77.journal", sweep.out,
                                        task.at("id").get<std::string>());
  const auto first = *contents.pieces.begin();
  Journal(begun, contents.key, false).keep(first.first, first.second);
  BOOST_TEST(contains(run("sweep", {"status", sweep.out}).out, {"1 begun and ended"}));
  BOOST_TEST(sweep.go("points").status == 0);
  // As text, since what is no number is unlike itself.
  BOOST_TEST(Journal::read(sweep.whole(task)).pieces.at(first.first).dump() == first.second.dump());
  BOOST_TEST(listing(sweep.out + "/tasks/begun") == "");
  // Seconds of another machine do not count.
  std::filesystem::remove(sweep.whole(task));
  contents.key["machine"]["cpu"] = "another";
  nlohmann::json slow = first.second;
  slow["time"] = 1e9;
  Journal(begun, contents.key, false).keep(first.first, slow);
  BOOST_TEST(sweep.go("points").status == 0);
  BOOST_TEST(Journal::read(sweep.whole(task)).pieces.at(first.first).dump() != slow.dump());
}

BOOST_AUTO_TEST_CASE(two_that_run_the_same_shard_do_no_harm) {
  const Sweep sweep;
  sweep.go("references");
  Started one("sweep", {"run", sweep.out, "--stage", "points"});
  Started two("sweep", {"run", sweep.out, "--stage", "points"});
  const Exit first = one.end(), second = two.end();
  // Each has done its tasks, or has seen that the other is at them.
  for (const Exit& end : {first, second}) BOOST_TEST((end.status == 0 || end.status == 3), end.err);
  check_as_one_process(sweep);
  BOOST_TEST(listing(sweep.out + "/tasks/begun") == "");
}

BOOST_AUTO_TEST_CASE(a_time_limit_ends_it_in_order_and_the_next_call_goes_on) {
  const Sweep sweep;
  sweep.go("references");
  int calls = 0;
  double limit =
      0.1;  // grows, since on a busy machine nothing might be measured in so short a time
  for (Exit end; end.status != 0; ++calls, limit *= 1.2) {
    BOOST_TEST_REQUIRE(limit < 1000);
    end = sweep.go("points", {"--time-limit", fmt::format("{}", limit)});
    if (end.status == 0) continue;
    BOOST_TEST(complains(end, 3, "sweep", {"interrupted by --time-limit"}), end.err);
  }
  BOOST_TEST(calls > 1);
  check_as_one_process(sweep);
}

BOOST_AUTO_TEST_CASE(other_studies_are_divided_in_the_same_way) {
  const std::map<std::string, std::string> studies = {
      {"stability_map",
       "program = \"stability_map\"\nscenes = [\"pendulum\"]\nuntil = 0.5\n"
       "methods = [\"verlet\", \"implicit_euler\", \"ida\"]\n[options]\n"
       "columns = 3\namplitudes = [0.1, 1]\ncell-limit = 60\n"},
      {"energy_drift",
       "program = \"energy_drift\"\nscenes = [\"orbit\"]\nuntil = 200\n"
       "methods = [\"verlet\", \"ida\"]\n[options]\nstep-size = 0.01\n"
       "method-limit = 60\n"}};
  const std::map<std::string, std::vector<std::string>> tables = {
      {"stability_map", {"limits.csv", "linear.csv", "adaptive.csv", "modal.csv", "map.csv"}},
      {"energy_drift", {"drift.csv"}}};
  for (const auto& [program, text] : studies) {
    const Sweep sweep(text);
    BOOST_TEST(sweep.planned.status == 0, sweep.planned.err);
    const Exit merged = sweep.go_and_merge();
    BOOST_TEST(merged.status == 0, merged.err);
    const auto task = sweep.tasks().front();
    std::vector<std::string> words = task.at("arguments");
    words.insert(words.end(), {"--out", sweep.folder / "one"});
    BOOST_TEST(run(program, words).status == 0);
    for (const std::string& table : tables.at(program)) {
      const std::string own =
          fmt::format("{}/{}/{}", sweep.out, task.at("folder").get<std::string>(), table);
      BOOST_TEST((read_all(own) == read_all(sweep.folder / ("one/" + table))), program + table);
    }
  }
}

BOOST_AUTO_TEST_CASE(ratios_of_crossover_and_cases_of_advice_are_tasks) {
  // One process would give up the slower of the two early at the second ratio.
  const Sweep crossover(
      "program = \"crossover\"\nmethods = [\"explicit_euler\", \"verlet\"]\n[options]\n"
      "family = \"chain\"\nnodes = 5\nratios = [1, 10]\nuntil = 0.02\nrepeats = 1\n"
      "point-limit = 0.05\n");
  BOOST_TEST(crossover.planned.status == 0, crossover.planned.err);
  const Exit merged = crossover.go_and_merge();
  BOOST_TEST(merged.status == 0, merged.err);
  const Table points = read_csv(crossover.out + "/crossover/points.csv");
  std::map<std::string, std::size_t> rows, pieces;  // by the ratio
  for (std::size_t row = 0; row < points.rows.size(); ++row) {
    // A run that will take too long is not begun.
    if (points.value(row, "steps") > 0) ++rows[points.text(row, "stiffness_ratio")];
  }
  for (const auto& task : crossover.tasks()) {
    const auto whole = Journal::read(crossover.whole(task)).pieces;
    pieces[task.at("share")] = whole.size() - 1;  // without the mark
  }
  BOOST_TEST((rows == pieces));
  BOOST_TEST(rows.size() == 2u);

  const Sweep advice(
      "program = \"advice\"\n[options]\ncases = 2\nfirst = 11000003\nrepeats = 1\n"
      "reference-seconds = 0.2\n");
  BOOST_TEST(advice.planned.status == 0, advice.planned.err);
  const auto tasks = advice.tasks();
  BOOST_TEST_REQUIRE(tasks.size() == 2u);
  const std::set<std::string> shares = {tasks[0].at("share"), tasks[1].at("share")};
  BOOST_TEST((shares == std::set<std::string>{"11000003", "11000004"}));
}

BOOST_AUTO_TEST_SUITE_END()
