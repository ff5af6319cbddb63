// LAMMPS beside our own velocity Verlet, step for step; what needs LAMMPS is skipped without it.
#include <fstream>
#include <random>
#include <sys/stat.h>

#include <boost/test/unit_test.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/bench/peer_ladder.hpp"
#include "tests/folder.hpp"

BOOST_AUTO_TEST_SUITE(lammps_peer)

using namespace qddot;
using namespace qddot::bench;

namespace {

constexpr double until = 0.2;

boost::test_tools::assertion_result lammps_is_there(boost::unit_test::test_unit_id) {
  static const std::string why = why_no_lammps();
  boost::test_tools::assertion_result result(why.empty());
  result.message() << why;
  return result;
}

// A scene with random nodes near the corners of a grid, two of them pinned, of three masses.
// Springs of random stiffness join random pairs, some twice and some of the pinned ones. They are
// stretched or compressed by up to a tenth; some have rest length zero.
Scene random_scene(int dimension, int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  Scene scene{.name = "random", .dimension = dimension, .until = until};
  for (int d = 0; d < dimension; ++d) scene.gravity[d] = number(-9, 9);
  for (int i = 0; i < 9; ++i) {
    Node node{.mass = 0.25 * (1 + i % 3), .pinned = i % 5 == 0};
    for (int d = 0; d < dimension; ++d) {
      node.position[d] = (dimension == 1 ? i : i / (d == 0 ? 1 : 3) % 3) + number(-0.2, 0.2);
      if (!node.pinned) node.velocity[d] = number(-0.3, 0.3);
    }
    if (dimension == 3) node.position[2] += i % 2;
    scene.nodes.push_back(node);
  }
  for (std::size_t a = 0; a < 9; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (a != b + 1 && number(0, 1) < 0.4) continue;
      const double l = (scene.nodes[a].position - scene.nodes[b].position).norm();
      const bool has_no_length = dimension > 1 && number(0, 1) < 0.2;  // on a line ends would meet
      const double rest_length = has_no_length ? 0 : number(0.9, 1.1) * l;
      scene.springs.push_back({{a, b}, {number(200, 2000), rest_length}});
      if (b == 2) scene.springs.push_back({{b, a}, {number(20, 200), rest_length}});
    }
  }
  scene.springs.push_back({{0, 5}, {1e6, 0}});
  return scene;
}

}  // namespace

struct Given {
  Folder folder;

  Problem problem(const Scene& scene) const {
    return {scene, scene, until, folder.path(), nlohmann::json::object()};
  }
};
// The two add the same numbers in another order, so each step differs by some roundings of a metre.
// Over some 50 steps of h w = 1/2 those grow by less than a factor of 1000.
BOOST_FIXTURE_TEST_CASE(steps_are_verlets_but_for_rounding, Given,
                        *boost::unit_test::precondition(lammps_is_there)) {
  const auto peer = lammps();
  for (const int dimension : {1, 2, 3}) {
    const Problem given = problem(random_scene(dimension, dimension));
    for (const bool smallest : {true, false}) {
      const SameSteps same = same_steps(*peer, smallest, given, 1, 60);
      BOOST_TEST_CONTEXT("dimension " << dimension) {
        BOOST_TEST(name(same.peer_outcome) == name(Outcome::reached_end));
        BOOST_TEST(name(same.outcome) == name(Outcome::reached_end));
        BOOST_TEST(same.steps > 10);
        BOOST_TEST(same.distance < 1e-12);
        BOOST_TEST(same.difference < 1e-12);
        BOOST_TEST(same.distance > 0);  // else it would be ours, twice
        BOOST_TEST(same.peer_step > 0);
        BOOST_TEST(same.step > 0);
      }
    }
  }
}

BOOST_FIXTURE_TEST_CASE(out_of_time_it_says_so, Given,
                        *boost::unit_test::precondition(lammps_is_there)) {
  const Run run = lammps()->run(problem(random_scene(3, 1)), ForceKind::its_own, 1e-9, 0.5);
  BOOST_TEST(name(run.outcome) == name(Outcome::over_budget));
  BOOST_TEST(run.seconds > 0);
}

// Each step at h w = 20 multiplies the motion by 400, until doubles overflow.
BOOST_FIXTURE_TEST_CASE(a_motion_that_explodes_is_not_finite, Given,
                        *boost::unit_test::precondition(lammps_is_there)) {
  Scene linear{.name = "linear", .until = until};
  linear.nodes = {{.pinned = true}, {.position = {1, 0, 0}, .mass = 1}};
  linear.springs = {{{0, 1}, {.stiffness = 1e8}}};
  const Run run = lammps()->run(problem(linear), ForceKind::its_own, 2e-3, 60);
  BOOST_TEST(name(run.outcome) == name(Outcome::not_finite));
}

BOOST_FIXTURE_TEST_CASE(a_program_that_is_missing_or_fails_is_told_in_a_sentence, Given) {
  BOOST_TEST(why_no_lammps(folder.path() + "/none") ==
             "LAMMPS is not there: apt-get install lammps");
  const std::string failing = folder.path() + "/lmp";
  std::ofstream(failing) << "#!/bin/sh\necho 'ERROR: Unknown bond style'\nexit 1\n";
  chmod(failing.c_str(), 0700);
  BOOST_TEST(why_no_lammps(failing) ==
             fmt::format("LAMMPS is left out, as {} fails on two atoms and a bond: "
                         "ERROR: Unknown bond style",
                         failing));
  const Run run = lammps(failing)->run(problem(random_scene(2, 1)), ForceKind::its_own, 0.01, 60);
  BOOST_TEST(name(run.outcome) == name(Outcome::solver_failed));
}

BOOST_AUTO_TEST_CASE(springs_that_are_not_harmonic_are_refused) {
  Scene scene = random_scene(3, 1);
  BOOST_TEST(lammps()->misfit(scene) == "");
  scene.springs.back().law.quartic = 1;
  BOOST_TEST(lammps()->misfit(scene) == "its harmonic bonds have no quartic stiffness");
  if (const auto peer = bullet()) {
    BOOST_TEST(peer->misfit(scene) == "its links have no quartic stiffness");
  }
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(lammps());
  peers.push_back(odeint_dopri5());
  LeftOut left_out;
  const auto fit = fitting(peers, scene, left_out);
  BOOST_TEST(fit.size() == 1u);
  BOOST_TEST(fit.front() == peers.back().get());
  BOOST_TEST(left_out.sentences() ==
                 std::vector<std::string>{"random: LAMMPS is left out: its harmonic bonds have no "
                                          "quartic stiffness"},
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_SUITE_END()
