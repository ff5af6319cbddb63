#include <map>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/generators.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(simulate_usage)

using namespace qddot;

namespace {

using Words = std::vector<std::string>;

// A good command line, as options and their values; each test spoils a part of it. All outputs are
// asked for, so that any file left behind is found. Values that end in .csv or .pc2 are in the
// folder.
std::map<std::string, Words> good_options() {
  return {{"--scene", {"oscillator"}}, {"--method", {"verlet"}}, {"--step-size", {"0.01"}},
          {"--until", {"1"}},          {"--final", {"f.csv"}},   {"--trajectory", {"g.csv"}},
          {"--energy", {"e.csv"}},     {"--motion", {"m.pc2"}},  {"--every", {"0.1"}}};
}

Words words_of(const std::map<std::string, Words>& options, const Folder& folder) {
  Words words;
  for (const auto& [option, values] : options) {
    words.push_back(option);
    for (const std::string& value : values) {
      words.push_back((value.ends_with(".csv") || value.ends_with(".pc2")) &&
                              !value.starts_with('/')
                          ? folder / value
                          : value);
    }
  }
  return words;
}

// The run is refused with one sentence that holds the fragments, and leaves no file.
void check_refused(const std::map<std::string, Words>& options, const Words& fragments) {
  const Folder folder;
  const Words words = words_of(options, folder);
  const Exit result = run("simulate", words);
  BOOST_TEST(complains(result, 2, "simulate", fragments), exit_in_words(result, words));
  BOOST_TEST(result.out == "");
  BOOST_TEST(folder.listing() == "", exit_in_words(result, words));
}

void check_value_refused(const std::string& option, const std::string& value,
                         const Words& fragments) {
  auto options = good_options();
  if (option == "--rtol" || option == "--atol") {
    options["--method"] = {"ida"};
    options.erase("--step-size");
    options["--rtol"] = {"1e-3"};
  }
  options[option] = {value};
  check_refused(options, fragments);
}

const std::array<const char*, 5> numeric_options = {"--step-size", "--rtol", "--atol", "--until",
                                                    "--every"};

}  // namespace

BOOST_AUTO_TEST_CASE(help_names_every_option) {
  for (const char* word : {"--help", "-h"}) {
    const Exit result = run("simulate", {word});
    BOOST_TEST(result.status == 0);
    BOOST_TEST(result.err == "");
    BOOST_TEST(contains(result.out, {"--scene", "--method", "--step-size", "--rtol", "--atol",
                                     "--until", "--final", "--trajectory", "--energy", "--every",
                                     "--write-scene", "--list-methods", "--list-scenes", "--csv"}));
  }
}

BOOST_AUTO_TEST_CASE(numbers_must_be_finite_and_positive) {
  const std::map<std::string, std::string> shown = {
      {"nan", "nan"}, {"inf", "inf"}, {"-inf", "-inf"}, {"0", "0"},
      {"-0.0", "-0"}, {"-1", "-1"},   {"1e999", "inf"}, {"-2.5e-3", "-0.0025"}};
  for (const char* option : numeric_options) {
    for (const auto& [value, words] : shown) {
      check_value_refused(option, value, {option, words, "not allowed", "greater than 0"});
    }
  }
}

BOOST_AUTO_TEST_CASE(tolerances_and_steps_that_cannot_mean_anything_are_refused) {
  for (const char* rtol : {"1", "2.5", "1e300", "1e-16", "1e-30"}) {
    check_value_refused("--rtol", rtol, {"--rtol", "not allowed", "from 1e-15", "below 1"});
  }
  // The oscillator measures 1 m, and goes at up to 10 m/s.
  for (const char* atol : {"10", "1e300", "1e-31", "1e-300"}) {
    check_value_refused("--atol", atol, {"--atol", "not allowed", "below 10"});
  }
  // A second holds no more than 1e15 steps.
  for (const char* h : {"9e-16", "1e-20"}) {
    check_value_refused("--step-size", h, {"--step-size", "not allowed", "at least 1e-15"});
  }
  check_value_refused("--step-size", "1e200", {"--step-size", "not allowed", "1e+150"});
}

BOOST_AUTO_TEST_CASE(tolerances_that_hardly_mean_anything_are_warned_of) {
  const auto run_at = [](const char* rtol, const char* atol) {
    return run("simulate", {"--scene", "oscillator", "--method", "ida", "--until", "0.01", "--rtol",
                            rtol, "--atol", atol});
  };
  BOOST_TEST(run_at("0.1", "1e-6").err == "");
  BOOST_TEST(contains(run_at("0.2", "1e-6").err, {"simulate: warning: --rtol 0.2", "hardly"}));
  BOOST_TEST(
      contains(run_at("1e-15", "1e-6").err, {"simulate: warning: --rtol 1e-15", "rounding"}));
  BOOST_TEST(contains(run_at("1e-6", "2").err, {"simulate: warning: --atol 2", "positions, 1 m"}));
}

BOOST_AUTO_TEST_CASE(a_long_run_says_how_long_it_will_take) {
  // 2e11 steps, minutes at the very least.
  const Exit result = run("simulate", {"--scene", "pendulum", "--method", "verlet", "--step-size",
                                       "1e-11", "--time-limit", "2.5"});
  BOOST_TEST(result.status == 3);
  BOOST_TEST(contains(result.err, {"simulate: t = ", "the run will take about "}), result.err);
}

BOOST_AUTO_TEST_CASE(what_is_no_number_is_named) {
  for (const char* option : numeric_options) {
    for (const char* value : {"text", "1,5", "1e-3x", "--final", "1 2"}) {
      check_value_refused(option, value, {option, value});
    }
  }
}

BOOST_AUTO_TEST_CASE(what_is_no_number_is_told_what_is_allowed) {
  for (const char* option : numeric_options) {
    check_value_refused(option, "text", {option, "text", "allowed"});
  }
}

BOOST_AUTO_TEST_CASE(a_value_that_is_missing_is_missed) {
  for (const auto& [option, values] : good_options()) {
    const Folder folder;
    auto others = good_options();
    others.erase(option);
    Words words = words_of(others, folder);
    words.push_back(option);
    const Exit result = run("simulate", words);
    BOOST_TEST(complains(result, 2, "simulate", {option}), exit_in_words(result, words));
    BOOST_TEST(folder.listing() == "");
  }
}

BOOST_AUTO_TEST_CASE(an_option_that_is_missing_is_missed) {
  for (const char* option : {"--scene", "--method", "--step-size", "--every"}) {
    auto options = good_options();
    options.erase(option);
    check_refused(options, {option, "missing"});
  }
  auto adaptive = good_options();
  adaptive.erase("--step-size");
  adaptive["--method"] = {"arkode_dirk4"};
  check_refused(adaptive, {"--rtol", "missing", "arkode_dirk4"});
  BOOST_TEST(complains(run("simulate", {}), 2, "simulate", {"--scene", "missing"}));
}

BOOST_AUTO_TEST_CASE(options_given_twice_or_unknown_are_refused) {
  for (const char* unknown : {"--stepsize", "--Scene", "-s", "stray", "--integrator=verlet"}) {
    auto options = good_options();
    options[unknown] = {};
    check_refused(options, {std::string(unknown).substr(0, std::string(unknown).find('='))});
  }
  for (const char* option : {"--step-size", "--until", "--method", "--scene", "--final"}) {
    const Folder folder;
    Words words = words_of(good_options(), folder);
    words.insert(words.end(), {option, "0.5"});
    const Exit result = run("simulate", words);
    BOOST_TEST(complains(result, 2, "simulate", {option}), exit_in_words(result, words));
  }
}

BOOST_AUTO_TEST_CASE(unknown_names_are_answered_with_the_known_ones) {
  Words method_names = {"--method", "leapfrog"}, scene_names = {"carpet"};
  for (const Method& method : methods()) method_names.push_back(method.name);
  for (const Generator& generator : generators()) scene_names.push_back(generator.name);
  check_value_refused("--method", "leapfrog", method_names);
  check_value_refused("--scene", "carpet", scene_names);
}

BOOST_AUTO_TEST_CASE(each_method_takes_its_own_knob_only) {
  for (const Method& method : methods()) {
    for (const char* knob : {"--step-size", "--rtol", "--atol"}) {
      const bool fixed = method.knob == Knob::step_size;
      if (fixed == (knob == std::string("--step-size"))) continue;
      auto options = good_options();
      options["--method"] = {method.name};
      if (!fixed) options["--rtol"] = {"1e-3"};
      if (!fixed) options.erase("--step-size");
      options[knob] = {"1e-3"};
      check_refused(options, {knob, method.name, fixed ? "--step-size" : "--rtol"});
    }
  }
}

BOOST_AUTO_TEST_CASE(every_is_for_outputs_over_time) {
  auto options = good_options();
  options.erase("--trajectory");
  options.erase("--energy");
  options.erase("--motion");
  check_refused(options, {"--every", "--trajectory", "--energy", "--motion"});
  check_value_refused("--every", "1e-12", {"--every", "1e-12", "allowed"});
  // The one before both outputs belongs to neither.
  const Folder folder;
  const Exit result = run("simulate", {"--scene", "orbit", "--method", "verlet", "--step-size",
                                       "0.01", "--every", "0.1", "--trajectory", folder / "g.csv",
                                       "--energy", folder / "e.csv", "--every", "0.2"});
  BOOST_TEST(complains(result, 2, "simulate", {"--every", "0.1", "--trajectory"}));
  BOOST_TEST(folder.listing() == "");
}

BOOST_AUTO_TEST_CASE(outputs_go_where_a_file_can_be_written) {
  for (const char* output : {"--final", "--trajectory", "--energy"}) {
    check_value_refused(output, "none/o.csv", {"none/o.csv", "cannot be written", "allowed"});
    check_value_refused(output, "/proc/o.csv", {"/proc/o.csv", "cannot be written", "allowed"});
    check_value_refused(output, "/", {"/: is a folder", "allowed"});
    check_value_refused(output, "/etc/passwd/o.csv", {"/etc/passwd/o.csv", "allowed"});
  }
}

BOOST_AUTO_TEST_CASE(an_output_without_a_name_is_refused) {
  for (const char* output : {"--final", "--trajectory", "--energy"}) {
    check_value_refused(output, "", {output});
  }
}

BOOST_AUTO_TEST_CASE(a_line_break_in_a_name_does_not_cut_the_sentence) {
  check_value_refused("--scene", "two\nlines", {"two", "lines", "allowed"});
  check_value_refused("--method", "two\nlines", {"two", "lines", "allowed"});
}

BOOST_AUTO_TEST_CASE(two_outputs_do_not_go_to_one_file) {
  // One way of writing its name or another, or the name of another's sidecar.
  for (const char* other : {"f.csv", "./f.csv", "f.json", "f"}) {
    const Folder folder;
    const Words words = {"--scene",     "oscillator",   "--method", "verlet",
                         "--step-size", "0.1",          "--final",  folder / "f.csv",
                         "--energy",    folder / other, "--every",  "1"};
    const Exit result = run("simulate", words);
    BOOST_TEST(complains(result, 2, "simulate", {other}), exit_in_words(result, words));
    BOOST_TEST(folder.listing() == "");
  }
}

BOOST_AUTO_TEST_CASE(a_sidecar_that_cannot_be_written_is_known_before_the_table) {
  const Folder folder;
  std::filesystem::create_directories(folder / "f.json");
  const Words words = words_of(good_options(), folder);
  const Exit result = run("simulate", words);
  BOOST_TEST(complains(result, 2, "simulate", {"f.json"}), exit_in_words(result, words));
  BOOST_TEST(folder.listing() == "f.json ");
}

BOOST_AUTO_TEST_CASE(negative_control_the_command_line_that_is_spoiled_is_good) {
  const Folder folder;
  const Exit result = run("simulate", words_of(good_options(), folder));
  BOOST_TEST(result.status == 0);
  BOOST_TEST(result.err == "");
  BOOST_TEST(folder.listing() == "e.csv e.json f.csv f.json g.csv g.json m.obj m.pc2 m.pc2.json ");
  BOOST_TEST(!complains(result, 0, "simulate", {}));
  BOOST_TEST(!complains({2, "", "simulate: two\nlines\n"}, 2, "simulate", {}));
  BOOST_TEST(!complains({2, "", "simulate: a\n"}, 2, "simulate", {"b"}));
}

BOOST_AUTO_TEST_SUITE_END()
