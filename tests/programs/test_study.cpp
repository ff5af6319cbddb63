#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <sys/stat.h>

#include <boost/test/unit_test.hpp>

#include "experiments/energy_drift/drift_record.hpp"
#include "experiments/kit/study.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "tests/folder.hpp"
#include "tests/fragments.hpp"

BOOST_AUTO_TEST_SUITE(study)

using namespace qddot;
using namespace qddot::energy_drift;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A study `map` in the folder of a table t.csv; `options`: "", --size N, --resume or both.
struct Case {
  Case(const Folder& folder, const std::string& options, const nlohmann::json& about = {}) {
    StudyCall call{.program = "map", .resumes = options.ends_with("--resume")};
    if (options.starts_with("--size ")) call.options["--size"] = {options.substr(7, 1)};
    study.emplace(call, folder.path(), std::vector<std::string>{"t.csv"}, about);
  }
  // The piece, and whether it was made now.
  std::pair<nlohmann::json, bool> piece(const std::string& name, const nlohmann::json& value) {
    bool is_made = false;
    const nlohmann::json found = study->piece(name, [&] {
      is_made = true;
      return value;
    });
    return {found, is_made};
  }

  std::optional<Study> study;
};

std::string refusal(const Folder& folder, const std::string& options,
                    const nlohmann::json& about = {}) {
  try {
    Case again(folder, options, about);
    return "";
  } catch (const InvalidInput& error) {
    return error.what();
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_was_measured_is_found_again_to_the_last_bit) {
  const Folder folder;
  const nlohmann::json values = {0.1, -0.0, infinity, -infinity, 5e-324, "a \xff b", nullptr, {1}};
  {
    Case first(folder, "");
    for (std::size_t i = 0; i < values.size(); ++i)
      BOOST_TEST(first.piece(std::to_string(i), values[i]).second);
    first.piece("nan", std::nan(""));
  }
  Case second(folder, "--resume");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto [found, is_made] = second.piece(std::to_string(i), "another");
    BOOST_TEST(!is_made);
    BOOST_TEST((found == values[i]),
               found.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
  }
  BOOST_TEST(std::signbit(second.piece("1", 1).first.get<double>()));
  BOOST_TEST(std::isnan(second.piece("nan", 1).first.get<double>()));
  BOOST_TEST(second.piece("new", 1).second);
}

BOOST_AUTO_TEST_CASE(a_journal_that_was_cut_anywhere_keeps_its_whole_pieces) {
  const Folder folder;
  const std::string file = folder / "map.journal";
  std::vector<std::size_t> ends;
  {
    Case first(folder, "");
    for (int i = 0; i < 5; ++i) {
      first.piece(std::to_string(i), 0.1 * i);
      ends.push_back(std::filesystem::file_size(file));
    }
  }
  const std::string whole = read_all(file);
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    folder.write("map.journal", whole.substr(0, cut));
    Case again(folder, "--resume");
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const auto [value, is_made] = again.piece(std::to_string(i), 0.1 * static_cast<int>(i));
      BOOST_TEST(is_made == (ends[i] > cut));
    }
  }
  // A bit that has changed ends what is believed as well.
  for (std::size_t at = whole.find('\n') + 1; at < whole.size(); at += 7) {
    std::string spoiled = whole;
    spoiled[at] = static_cast<char>(spoiled[at] ^ 4);
    folder.write("map.journal", spoiled);
    Case again(folder, "--resume");
    for (std::size_t i = 0; i < ends.size(); ++i)
      BOOST_TEST(again.piece(std::to_string(i), 0.1 * static_cast<int>(i)).second ==
                 (ends[i] > at));
  }
}

BOOST_AUTO_TEST_CASE(other_options_and_other_scenes_are_refused_and_lose_nothing) {
  const Folder folder;
  { Case(folder, "--size 1", {{"scene", "a"}}).piece("p", 1); }
  const std::string before = read_all(folder / "map.journal");
  BOOST_TEST(contains(refusal(folder, "--size 2 --resume", {{"scene", "a"}}),
                      {"--size", "\"1\"", "\"2\""}));
  BOOST_TEST(contains(refusal(folder, "--resume", {{"scene", "a"}}), {"--size"}));
  BOOST_TEST(
      contains(refusal(folder, "--size 1 --resume", {{"scene", "b"}}), {"scene", "allowed"}));
  BOOST_TEST((read_all(folder / "map.journal") == before));
  BOOST_TEST(refusal(folder, "--size 1 --resume", {{"scene", "a"}}) == "");
}

BOOST_AUTO_TEST_CASE(without_resume_all_is_measured_anew) {
  const Folder folder;
  { Case(folder, "").piece("p", 1); }
  Case again(folder, "");
  BOOST_TEST(again.piece("p", 2).second);
}

BOOST_AUTO_TEST_CASE(a_file_of_somebody_else_is_neither_read_nor_replaced) {
  const Folder folder;
  for (const char* own : {"my notes\n", "qddot journal 2\n"}) {
    folder.write("map.journal", own);
    for (const char* options : {"", "--resume"})
      BOOST_TEST(contains(refusal(folder, options), {"map.journal", "--force"}));
    BOOST_TEST((read_all(folder / "map.journal") == own));
  }
  std::filesystem::remove(folder / "map.journal");
  BOOST_TEST_REQUIRE(::mkfifo((folder / "map.journal").c_str(), 0600) == 0);
  for (const char* options : {"", "--resume"})
    BOOST_TEST(contains(refusal(folder, options), {"map.journal", "is no file"}));
}

BOOST_AUTO_TEST_CASE(two_at_once_in_one_folder_are_refused) {
  const Folder folder;
  Case first(folder, "");
  BOOST_TEST(contains(refusal(folder, "--resume"), {"map.journal", "another process"}));
}

BOOST_AUTO_TEST_CASE(a_complete_study_is_not_measured_again) {
  const Folder folder;
  {
    Case first(folder, "--size 1");
    first.piece("p", 1);
    CsvFile table(folder / "t.csv", {"x"});
    first.study->complete(table, nlohmann::json::object(), 3);
    BOOST_TEST(first.study->conclude(3) == 3);
  }
  BOOST_TEST(folder.listing() == "t.csv t.json ");
  BOOST_TEST((Case(folder, "--size 1 --resume").study->completed() == std::optional(3)));
  BOOST_TEST(!Case(folder, "--size 2 --resume").study->completed());
  BOOST_TEST(!Case(folder, "--size 1").study->completed());
  std::filesystem::remove(folder / "t.csv");
  BOOST_TEST(!Case(folder, "--size 1 --resume").study->completed());
}

BOOST_AUTO_TEST_CASE(runs_come_back_whole) {
  DriftRun run{.method = find_method("ida"), .value = 1e-5};
  run.energy.drift = {1, 2, 3};
  run.energy.slow_period = infinity;
  run.energy.colour = Colour::undecided;
  run.linear.emplace().walk = 4;
  run.path = {{0, 1, 2}, {3, 4, 5}};
  run.summary.message = "why";
  const DriftRun again =
      drift_run_of(nlohmann::json::from_cbor(nlohmann::json::to_cbor(record_of(run))));
  BOOST_TEST(again.energy.slow_period == infinity);
  BOOST_TEST((again.energy.colour == Colour::undecided));
  BOOST_TEST(again.linear->walk == 4);
  BOOST_TEST(!again.angular);
  BOOST_TEST((record_of(again).dump() == record_of(run).dump()));
}

BOOST_AUTO_TEST_SUITE_END()
