#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(interruption)

using namespace qddot;

namespace {

using Words = std::vector<std::string>;

// Waits until the file is there and holds the text, at most two minutes.
void wait_for(const std::string& file, const std::string& text = "") {
  const auto is_there = [&] {
    return std::filesystem::exists(file) && read_all(file).find(text) != std::string::npos;
  };
  for (int i = 0; i < 12000 && !is_there(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

// A run that is long, into long.csv.
Words long_run(const Folder& folder) {
  return {"--scene", "oscillator", "--method", "verlet",  "--step-size",
          "1e-9",    "--until",    "1e3",      "--final", folder / "long.csv"};
}

nlohmann::json json_in(const std::string& file) { return nlohmann::json::parse(read_all(file)); }

}  // namespace

BOOST_AUTO_TEST_CASE(signals_end_a_run_with_what_it_reached) {
  for (const auto& [signal, name] : {std::pair(SIGINT, "SIGINT"), std::pair(SIGTERM, "SIGTERM")}) {
    const Folder folder;
    Started started("simulate", long_run(folder));
    started.let_work(0.3);  // some of which it needs to begin
    const Exit result = started.end(signal);
    BOOST_TEST(complains(result, 130, "simulate", {"interrupted", name, "of 1000 s reached"}),
               result.err);
    BOOST_TEST(folder.listing() == "long.csv long.json ");
    BOOST_TEST(read_csv(folder / "long.csv").rows.size() == 2);
    const auto sidecar = json_in(folder / "long.json");
    BOOST_TEST(sidecar.at("interrupted") == name);
    BOOST_TEST(sidecar.at("t_reached").get<double>() < 1e3);
  }
}

BOOST_AUTO_TEST_CASE(a_time_limit_ends_a_run_in_order) {
  const Folder folder;
  Words words = long_run(folder);
  words.insert(words.end(), {"--time-limit", "0.3"});
  const Exit result = run("simulate", words);
  BOOST_TEST(complains(result, 3, "simulate", {"--time-limit", "reached"}), result.err);
  BOOST_TEST(json_in(folder / "long.json").at("interrupted") == "--time-limit");
  check_refused("simulate", {"--scene", "cloth", "--time-limit", "0"},
                {"--time-limit 0", "greater"});
}

BOOST_AUTO_TEST_CASE(negative_control_a_run_that_ends_by_itself_is_not_interrupted) {
  const Folder folder;
  const Exit result =
      run("simulate", {"--scene", "oscillator", "--method", "verlet", "--step-size", "0.01",
                       "--until", "1", "--final", folder / "a.csv", "--time-limit", "1e9"});
  BOOST_TEST(result.status == 0);
  BOOST_TEST(json_in(folder / "a.json").at("interrupted").is_null());
}

BOOST_AUTO_TEST_CASE(an_interrupted_study_goes_on_to_the_same_points) {
  const Folder folder;
  const Words words = {"--scene",   "oscillator", "--methods", "verlet,rk4,blanes_moan4,ida",
                       "--repeats", "1",          "--until",   "1"};
  const auto study = [&](const std::string& out, const Words& more) {
    Words all = words;
    all.insert(all.end(), {"--out", folder / out});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  BOOST_TEST(run("convergence", {"--scene", "oscillator", "--methods", "verlet,rk4", "--until",
                                 "20", "--out", folder / "whole"})
                 .status == 0);
  const Words half = {"--scene", "oscillator", "--methods", "verlet,rk4",
                      "--until", "20",         "--out",     folder / "half"};
  Started killed("convergence", half);
  wait_for(folder / "half/convergence.journal");
  BOOST_TEST(killed.end(SIGKILL).status == 128 + SIGKILL);
  Words resumed = half;
  resumed.push_back("--resume");
  BOOST_TEST(run("convergence", resumed).status == 0);
  BOOST_TEST((read_all(folder / "half/order.csv") == read_all(folder / "whole/order.csv")));
  for (const auto& entry : std::filesystem::directory_iterator(folder / "half")) {
    BOOST_TEST((entry.path().extension() == ".csv" || entry.path().extension() == ".json"),
               entry.path());
  }

  Started ended("work_precision", study("ended", {}));
  // A study whose journal has no piece yet has nothing to save.
  wait_for(folder / "ended/work_precision.journal", "outcome");
  const Exit result = ended.end(SIGINT);
  BOOST_TEST(complains(result, 130, "work_precision", {"interrupted by SIGINT", "--resume"}),
             result.err);
  const std::size_t before = read_csv(folder / "ended/points.csv").rows.size();
  BOOST_TEST(json_in(folder / "ended/points.json").at("interrupted") == "SIGINT");
  const Exit rest = run("work_precision", study("ended", {"--resume"}));
  BOOST_TEST(rest.status == 0);
  BOOST_TEST(json_in(folder / "ended/points.json").at("interrupted").is_null());
  BOOST_TEST(read_csv(folder / "ended/points.csv").rows.size() >= before);
  BOOST_TEST(
      contains(run("work_precision", study("ended", {"--resume"})).err, {"nothing is missing"}));
}

BOOST_AUTO_TEST_CASE(unfinished_files_of_the_dead_go_and_those_of_the_living_stay) {
  const Folder folder;
  folder.write("a.csv.999999.part", "half");
  folder.write("a.csv.part", "the user's");
  folder.write("notes.part", "the user's");
  Started living("simulate", long_run(folder));
  for (int i = 0; i < 12000 && folder.listing().find("long.json") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const Exit other = run("simulate", {"--scene", "oscillator", "--method", "verlet", "--step-size",
                                      "0.01", "--until", "1", "--final", folder / "b.csv"});
  BOOST_TEST(other.status == 0);
  const std::string listing = folder.listing();
  BOOST_TEST(!contains(listing, {"999999"}), listing);
  BOOST_TEST(contains(listing, {"a.csv.part", "notes.part", "long.csv.", "b.csv"}), listing);
  BOOST_TEST(living.end(SIGTERM).status == 130);
  BOOST_TEST(folder.listing() == "a.csv.part b.csv b.json long.csv long.json notes.part ");
}

BOOST_AUTO_TEST_SUITE_END()
