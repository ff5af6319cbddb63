#include <cmath>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "qddot/integrators/registry.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(simulate_scenes)

using namespace qddot;

namespace {

using Words = std::vector<std::string>;

Words knob_of(const Method& method) {
  return method.knob == Knob::step_size ? Words{"--step-size", "0.01"} : Words{"--rtol", "1e-4"};
}

// Runs a method on a scene and asks for the end.
Exit simulate(const std::string& scene, const Method& method, const Folder& folder,
              const Words& more = {}) {
  Words words = {"--scene", scene, "--method", method.name, "--final", folder / "f.csv"};
  for (const Words& part : {knob_of(method), more})
    words.insert(words.end(), part.begin(), part.end());
  return run("simulate", words);
}

Exit verlet(const Folder& folder, const Words& options) {
  Words words = {"--method", "verlet",         "--final", folder / "f.csv",
                 "--energy", folder / "e.csv", "--every", "1"};
  words.insert(words.end(), options.begin(), options.end());
  return run("simulate", words);
}

const std::string massless =
    "dimension = 1\nuntil = 0.5\n"
    "nodes = [{position = [0], pinned = true}, {position = [1], mass = 0},"
    " {position = [2.5], mass = 1}]\n"
    "springs = [{nodes = [0, 1], stiffness = 30, rest_length = 1},"
    " {nodes = [1, 2], stiffness = 60, rest_length = 1}]\n";

const std::string quartic_massless =
    "dimension = 1\nuntil = 0.5\n"
    "nodes = [{position = [0], pinned = true}, {position = [1], mass = 0},"
    " {position = [2.5], mass = 1}]\n"
    "springs = [{nodes = [0, 1], stiffness = 30, rest_length = 1, quartic = 1},"
    " {nodes = [1, 2], stiffness = 60, rest_length = 1}]\n";

// All numbers of a table are finite.
bool is_finite(const Table& table) {
  for (const auto& row : table.rows) {
    for (const std::string& field : row) {
      if (!std::isfinite(number(field))) return false;
    }
  }
  return true;
}

}  // namespace

BOOST_AUTO_TEST_CASE(without_a_spring_nodes_fly_freely) {
  const Folder folder;
  const std::string scene = folder.write(
      "s.toml",
      "dimension = 2\nuntil = 0.5\n"
      "nodes = [{position = [1, 2], velocity = [3, -4], mass = 2}, {position = [0, 0], mass = 1}]");
  for (const Method& method : methods()) {
    const Exit result = simulate(scene, method, folder);
    BOOST_TEST(result.status == 0, method.name << ": " << result.err);
    const Table end = read_csv(folder / "f.csv");
    BOOST_TEST(end.value(0, "x") == 2.5, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(std::abs(end.value(0, "y")) < 1e-12);
    BOOST_TEST(end.value(0, "vy") == -4, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(end.value(1, "x") == 0);
  }
}

BOOST_AUTO_TEST_CASE(where_all_is_pinned_nothing_moves_and_every_method_is_done) {
  const Folder folder;
  const std::string scene =
      folder.write("s.toml",
                   "dimension = 3\nuntil = 0.5\ngravity = [0, 0, -9.81]\n"
                   "nodes = [{position = [0, 1, 2], velocity = [1, 1, 1], pinned = true},"
                   " {position = [3, 4, 5], pinned = true}]\n"
                   "springs = [{nodes = [0, 1], stiffness = 10, rest_length = 1}]\n");
  for (const Method& method : methods()) {
    const Exit result =
        simulate(scene, method, folder, {"--energy", folder / "e.csv", "--every", "0.25"});
    BOOST_TEST(result.status == 0, method.name << ": " << result.err);
    if (result.status != 0) continue;
    BOOST_TEST(read_all(folder / "f.csv") == "node,x,y,z,vx,vy,vz\n0,0,1,2,0,0,0\n1,3,4,5,0,0,0\n");
    const Table energy = read_csv(folder / "e.csv");
    BOOST_TEST_REQUIRE(energy.rows.size() == 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      BOOST_TEST(energy.value(i, "kinetic") == 0);
      BOOST_TEST(energy.value(i, "total") == 5 * std::pow(std::sqrt(27) - 1, 2),
                 boost::test_tools::tolerance(1e-14));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_massless_node_is_for_methods_that_accept_it) {
  // Two springs in series cannot be replaced by one if one of them is quartic.
  for (const Method& method : methods()) {
    const Folder folder;
    const std::string scene = folder.write("s.toml", quartic_massless);
    const Exit result = simulate(scene, method, folder);
    if (method.is(Trait::accepts_massless)) {
      BOOST_TEST(result.status == 0, method.name << ": " << result.err);
      BOOST_TEST(result.err == "");
    } else {
      BOOST_TEST(complains(result, 2, "simulate", {scene, "nodes[1].mass: 0", "implicit_euler"}) ==
                     (!method.asks(Need::constant_stiffness) && !method.asks(Need::split_forces)),
                 method.name << ": " << result.err);
      BOOST_TEST(result.status == 2);
      BOOST_TEST(folder.listing() == "s.toml ");
    }
  }
}

BOOST_AUTO_TEST_CASE(two_springs_in_series_are_one_while_in_tension) {
  const Folder folder;
  const std::string scene = folder.write("s.toml", massless);
  // k = 20 N/m: a quarter of the period 2 pi sqrt(1/20) s, and 0.5 m of stretch, until it is slack.
  const double slack = M_PI / 2 / std::sqrt(20.0);
  const Method& method = *find_method("verlet");
  const Exit stopped = simulate(scene, method, folder);
  BOOST_TEST(complains(stopped, 3, "simulate", {"of 0.5 s", "compression", "--no-reduce massless"}),
             stopped.err);
  const auto sidecar = nlohmann::json::parse(read_all(folder / "f.json"));
  BOOST_TEST(sidecar.at("outcome") == "went_slack");
  const double reached = sidecar.at("t_reached");
  BOOST_TEST((reached <= slack && reached > slack - 0.02));
  const Exit before = simulate(scene, method, folder, {"--until", "0.3"});
  BOOST_TEST(before.status == 0, before.err);
  const Table end = read_csv(folder / "f.csv");
  // Verlet's error at h w < 0.05 is below (h w)^2 w t / 24.
  const double tip = 2 + 0.5 * std::cos(std::sqrt(20.0) * 0.3);
  BOOST_TEST(std::abs(end.value(2, "x") - tip) < 2e-4);
  BOOST_TEST(30 * (end.value(1, "x") - 1) == 60 * (end.value(2, "x") - end.value(1, "x") - 1),
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(30 * end.value(1, "vx") == 60 * (end.value(2, "vx") - end.value(1, "vx")),
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(a_massless_node_stands_where_its_springs_balance) {
  const Folder folder;
  const Method& method = *find_method("implicit_euler");
  BOOST_TEST(simulate(folder.write("s.toml", massless), method, folder).status == 0);
  const Table end = read_csv(folder / "f.csv");
  const double x = end.value(1, "x"), tip = end.value(2, "x");
  BOOST_TEST(30 * (x - 1) == 60 * (tip - x - 1), boost::test_tools::tolerance(1e-9));
  BOOST_TEST(end.value(0, "x") == 0);
}

BOOST_AUTO_TEST_CASE(the_horizon_is_the_scenes_own_unless_asked_for) {
  const std::string with_until = "dimension = 1\nuntil = 2\nnodes = [{position = [0], mass = 1}]";
  const auto last_time = [](const Folder& folder) {
    const Table energy = read_csv(folder / "e.csv");
    return energy.value(energy.rows.size() - 1, "t");
  };
  const Folder folder;
  const std::string scene = folder.write("s.toml", with_until);
  BOOST_TEST(verlet(folder, {"--scene", scene, "--step-size", "0.1"}).status == 0);
  BOOST_TEST(last_time(folder) == 2);
  BOOST_TEST(verlet(folder, {"--scene", scene, "--step-size", "0.1", "--until", "3"}).status == 0);
  BOOST_TEST(last_time(folder) == 3);
}

BOOST_AUTO_TEST_CASE(above_its_limit_an_explicit_method_diverges_and_says_so) {
  // w = 10 rad/s: h w = 3 is above Verlet's limit of 2.
  const Folder folder;
  const Exit result =
      verlet(folder, {"--scene", "oscillator", "--step-size", "0.3", "--until", "99"});
  const Table end = read_csv(folder / "f.csv"), energy = read_csv(folder / "e.csv");
  const auto sidecar = nlohmann::json::parse(read_all(folder / "f.json"));
  BOOST_TEST(sidecar.at("outcome") == "diverged");
  const double t_reached = sidecar.at("t_reached");
  BOOST_TEST((t_reached > 1 && t_reached < 99));
  BOOST_TEST(
      complains(result, 3, "simulate", {fmt::format("{} of 99 s", t_reached), "smaller step"}),
      result.err);
  BOOST_TEST(is_finite(end));
  BOOST_TEST(std::abs(end.value(1, "vx")) > 1e20);
  // All samples before the end are there.
  BOOST_TEST(is_finite(energy));
  BOOST_TEST(energy.rows.size() == std::floor(t_reached) + 1);
}

BOOST_AUTO_TEST_CASE(after_millions_of_steps_samples_still_land_on_steps) {
  // The rounding of t alone is some 1e-9 of a step at t/h = 13 million.
  const Folder folder;
  const Words options = {"--scene", "oscillator", "--step-size", "5e-6", "--until", "66"};
  Words words = {"--method", "verlet", "--final", folder / "alone.csv"};
  words.insert(words.end(), options.begin(), options.end());
  const Exit alone = run("simulate", words);
  words[3] = folder / "seen.csv";
  words.insert(words.end(), {"--energy", folder / "e.csv", "--every", "0.005"});
  const Exit seen = run("simulate", words);
  BOOST_TEST(untimed(alone) == untimed(seen));  // as many steps
  BOOST_TEST(read_all(folder / "alone.csv") == read_all(folder / "seen.csv"));
}

BOOST_AUTO_TEST_CASE(negative_control_below_its_limit_it_arrives) {
  const Folder folder;
  const Exit result =
      verlet(folder, {"--scene", "oscillator", "--step-size", "0.19", "--until", "99"});
  BOOST_TEST(result.status == 0);
  BOOST_TEST(std::abs(read_csv(folder / "f.csv").value(1, "x")) < 10);
  BOOST_TEST(!is_finite(parse_csv("a\ninf\n")));
}

BOOST_AUTO_TEST_SUITE_END()
