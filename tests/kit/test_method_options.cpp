#include <cmath>

#include <boost/test/unit_test.hpp>

#include "qddot/integrators/registry.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(method_options)

using namespace qddot;

namespace {

using Words = std::vector<std::string>;

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Exit simulate(const std::string& method, const Words& more) {
  const bool is_fixed = find_method(method)->knob == Knob::step_size;
  return run("simulate", joined({"--scene", "orbit", "--method", method, "--until", "0.1",
                                 is_fixed ? "--step-size" : "--rtol", "1e-3"},
                                more));
}

Exit measure(const std::string& out, const std::string& list, const Words& more,
             const std::string& scene = "orbit") {
  return run("work_precision", joined({"--scene", scene, "--until", "0.5", "--methods", list,
                                       "--point-limit", "0.05", "--repeats", "1", "--out", out},
                                      more));
}

// Both programs refuse the words with one sentence that holds the fragments, and make no file.
void check_refused(const Words& words, const Words& fragments) {
  const Exit one = simulate("ida", words);
  BOOST_TEST(complains(one, 2, "simulate", fragments), exit_in_words(one, words));
  const Folder folder;
  const Exit many = measure(folder / "out", "ida", words);
  BOOST_TEST(complains(many, 2, "work_precision", fragments), exit_in_words(many, words));
  BOOST_TEST(one.out + many.out == "");
  BOOST_TEST(folder.listing() == "");
}

// points.csv of some methods; `scene` is a file's text, or orbit where there is none.
Table points(const std::string& list, const Words& more, const std::string& scene = "") {
  const Folder folder;
  const Exit result = measure(folder / "out", list, more,
                              scene.empty() ? "orbit" : folder.write("scene.toml", scene));
  BOOST_TEST_REQUIRE(result.status == 0, exit_in_words(result, more));
  return read_csv(folder / "out/points.csv");
}

// 30 masses in a row between two pins, linear, that start in their slowest mode. The h w of the
// other modes lie where vibrations grow with BDF of order 3 to 5.
std::string slowest_mode() {
  constexpr int masses = 30;
  std::string nodes, springs;
  for (int i = 0; i <= masses + 1; ++i) {
    const double place = i + (i <= masses ? std::sin(i * M_PI / (masses + 1)) : 0);
    nodes += fmt::format("{{position = [{:.17g}], {}}},\n", place,
                         i == 0 || i > masses ? "pinned = true" : "mass = 1e-3");
    if (i > 0) {
      springs += fmt::format("{{nodes = [{}, {}], stiffness = 1e3, rest_length = 0}},\n", i - 1, i);
    }
  }
  return fmt::format("dimension = 1\nnodes = [{}]\nsprings = [{}]\n", nodes, springs);
}

// A slow vibration of two masses that a spring 1e6 times stiffer holds together.
const std::string held =
    "dimension = 1\n"
    "nodes = [{position = [0], pinned = true}, {position = [1], mass = 1},\n"
    "         {position = [2], mass = 1}]\n"
    "springs = [{nodes = [0, 1], stiffness = 1, rest_length = 0},\n"
    "           {nodes = [1, 2], stiffness = 1e6}]\n";

}  // namespace

BOOST_AUTO_TEST_CASE(orders_that_no_method_has_are_refused) {
  for (const char* value : {"0", "-1", "13", "100"}) {
    check_refused({"--max-order", value}, {"--max-order", value, "not allowed", "from 1 to"});
  }
  for (const char* value : {"text", "1.5", "nan", "99999999999999999999"}) {
    check_refused({"--max-order", value}, {"--max-order", value, "allowed is a number"});
  }
  check_refused({"--max-order"}, {"--max-order"});
  check_refused({"--max-order", "2", "--max-order", "0"}, {"--max-order 0", "from 1 to"});
}

BOOST_AUTO_TEST_CASE(a_method_is_allowed_its_own_orders) {
  for (const Method& method : methods()) {
    if (!method.varies_order()) continue;
    for (const int order : {1, method.order}) {
      const Exit good = simulate(method.name, {"--max-order", std::to_string(order)});
      BOOST_TEST(good.status == 0, method.name << ": " << good.err);
    }
    const std::string above = std::to_string(method.order + 1);
    BOOST_TEST(complains(simulate(method.name, {"--max-order", above}), 2, "simulate",
                         {"--max-order " + above, "from 1 to " + std::to_string(method.order)}));
  }
}

BOOST_AUTO_TEST_CASE(methods_of_one_order_are_told_whom_the_options_are_for) {
  Words variable, detecting;
  for (const Method& method : methods()) {
    if (method.varies_order()) variable.push_back(method.name);
    if (method.listens_to(Option::stability_detection)) detecting.push_back(method.name);
  }
  for (const char* name : {"verlet", "arkode_dirk4", "arkode_trbdf2"}) {
    BOOST_TEST(complains(simulate(name, {"--max-order", "2"}), 2, "simulate",
                         joined({"--max-order is not for " + std::string(name)}, variable)));
  }
  for (const char* name : {"verlet", "arkode_dirk4", "cvode_adams", "ida"}) {
    BOOST_TEST(
        complains(simulate(name, {"--stability-detection"}), 2, "simulate",
                  joined({"--stability-detection is not for " + std::string(name)}, detecting)));
  }
  for (const std::string& name : detecting) {
    BOOST_TEST(simulate(name, {"--stability-detection"}).status == 0, name);
  }
}

BOOST_AUTO_TEST_CASE(given_twice_the_last_counts) {
  BOOST_TEST(simulate("ida", {"--max-order", "77", "--max-order", "2"}).status == 0);
  const Table table = points("ida", {"--max-order", "5", "--max-order", "1"});
  BOOST_TEST_REQUIRE(table.rows.size() > 0u);
  BOOST_TEST(table.value(0, "order_mean") == 1);
}

BOOST_AUTO_TEST_CASE(up_to_order_1_every_step_is_of_order_1) {
  const std::string list = "ida,cvode_bdf,cvode_adams";
  const Table low = points(list, {"--max-order", "1"}), own = points(list, {});
  int reductions = 0;
  for (std::size_t row = 0; row < low.rows.size(); ++row) {
    if (low.value(row, "steps") == 0) continue;
    BOOST_TEST(low.value(row, "order_mean") == 1);
    BOOST_TEST(low.value(row, "order_reductions") == 0);
  }
  for (std::size_t row = 0; row < own.rows.size(); ++row) {
    if (own.text(row, "outcome") != "reached_end") continue;
    const double order = own.value(row, "order_mean");
    const double highest = find_method(own.text(row, "method"))->order;
    BOOST_TEST((order > 1 && order < highest), own.text(row, "method") << " " << order);
    reductions += own.value(row, "order_reductions") > 0;
  }
  BOOST_TEST(reductions > 0);
}

BOOST_AUTO_TEST_CASE(stability_detection_is_heard_by_bdf_alone) {
  // Both to their ends, however slow the machine: a run that is cut off has other steps.
  const std::string list = "cvode_bdf,cvode_adams";
  const Words to_the_end{"--point-limit", "100"};
  const Table without = points(list, to_the_end, slowest_mode());
  const Table with = points(list, joined({"--stability-detection"}, to_the_end), slowest_mode());
  const auto order = [](const Table& table, const std::string& method, std::size_t number) {
    std::size_t row = 0;
    while (table.text(row, "method") != method) ++row;
    return table.value(row + number, "order_mean");
  };
  const std::size_t number = 4;  // rtol = 1e-5
  BOOST_TEST(order(with, "cvode_bdf", number) < order(without, "cvode_bdf", number));
  BOOST_TEST(order(with, "cvode_adams", number) == order(without, "cvode_adams", number));
}

BOOST_AUTO_TEST_CASE(options_of_how_steps_are_solved_are_refused_where_they_mean_nothing) {
  struct {
    const char *option, *method, *good, *bad, *allowed, *other;
  } const cases[] = {
      {"--iterations", "local_global", "3", "0", "a whole number from 1", "implicit_euler"},
      {"--iterations", "local_global", "3", "1000000000", "to 100000", "implicit_euler"},
      {"--solve-tolerance", "implicit_euler", "1e-8", "1", "between 0 and 1", "local_global"},
      {"--solve-tolerance", "bdf2", "0.1", "0", "between 0 and 1", "verlet"},
      {"--spectral-radius", "hht", "0", "1.5", "from 0 to 1", "trapezoidal"},
      {"--spectral-radius", "generalized_alpha", "1", "-1", "from 0 to 1", "ida"},
      {"--solver", "implicit_euler", "conjugate_gradients", "lu", "multifrontal", "verlet"},
      {"--solver", "ida", "cholmod", "klu", "one of automatic", "ida_klu"}};
  for (const auto& [option, method, good, bad, allowed, other] : cases) {
    BOOST_TEST_CONTEXT(option << " " << method) {
      BOOST_TEST(simulate(method, {option, good}).status == 0);
      BOOST_TEST(complains(simulate(method, {option, bad}), 2, "simulate",
                           {std::string(option) + " " + bad, allowed}));
      BOOST_TEST(complains(simulate(other, {option, good}), 2, "simulate",
                           {std::string(option) + " is not for " + other, method}));
      const Folder folder;
      BOOST_TEST(complains(measure(folder / "out", method, {option, bad}), 2, "work_precision",
                           {std::string(option) + " " + bad, allowed}));
      BOOST_TEST(folder.listing() == "");
    }
  }
}

BOOST_AUTO_TEST_CASE(iterations_follow_the_solve_tolerance_and_damping_the_spectral_radius) {
  // One of the step sizes, counted from the coarsest: their number depends on the time they take.
  const auto seventh = [](const Table& table, const char* column) {
    return table.value(6, column);
  };
  const Table loose = points("trapezoidal", {"--solve-tolerance", "1e-2"});
  const Table tight = points("trapezoidal", {"--solve-tolerance", "1e-12"});
  BOOST_TEST(seventh(tight, "steps") == seventh(loose, "steps"));
  BOOST_TEST(seventh(tight, "newton_iterations") > seventh(loose, "newton_iterations"));
  const Table damped = points("generalized_alpha", {"--spectral-radius", "0"});
  const Table undamped = points("generalized_alpha", {"--spectral-radius", "1"});
  BOOST_TEST(seventh(damped, "error_energy") > 10 * seventh(undamped, "error_energy"));
}

BOOST_AUTO_TEST_CASE(the_columns_are_empty_or_0_where_they_mean_nothing) {
  const std::string list = "verlet,implicit_euler,arkode_dirk4,arkode_erk4,arkode_trbdf2,ida";
  const Table table = points(list, {}, held);
  double limited = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const Method& method = *find_method(table.text(row, "method"));
    BOOST_TEST_CONTEXT(method.name) {
      const bool has_order = method.varies_order() && table.value(row, "steps") > 0;
      BOOST_TEST((table.text(row, "order_mean") != "") == has_order);
      const double reductions = table.value(row, "order_reductions");
      BOOST_TEST((reductions == 0 || method.varies_order()));
      const double indefinite = table.value(row, "indefinite_factorizations");
      BOOST_TEST(indefinite <= table.value(row, "factorizations"));
      BOOST_TEST((indefinite == 0 || method.is(Trait::implicit)));
      const double held_steps = table.value(row, "stability_limited_steps");
      BOOST_TEST(held_steps <= table.value(row, "steps") + table.value(row, "rejected"));
      BOOST_TEST((held_steps == 0 || method.name == "arkode_erk4"));
      limited += held_steps;
    }
  }
  BOOST_TEST(limited > 0);
}

BOOST_AUTO_TEST_SUITE_END()
