#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(samples)

using namespace qddot;

namespace {

struct Hard {
  Problem problem;
  double until, length, speed;
};

struct Random {
  std::mt19937 engine;
  double uniform(double low, double high) {
    return std::uniform_real_distribution(low, high)(engine);
  }
  double decades(double low, double high) { return std::pow(10, uniform(low, high)); }
  Vec vector(Index n, double size) {
    return Vec::NullaryExpr(n, [&] { return uniform(-size, size); });
  }
};

// A mass that flies past the anchor of its spring at a small distance, so that steps shrink a
// hundred times within a few; another one hangs on it.
Hard near_miss(Random& random) {
  const int dimension = random.uniform(0, 1) < 0.5 ? 2 : 3;
  Problem p{{.dimension = dimension, .node_mass = Vec{{1, random.uniform(0.3, 2)}}},
            {0, Vec::Zero(2 * dimension), Vec::Zero(2 * dimension)}};
  const double speed = random.decades(0, 1.3);
  p.network.anchors = {{0, {0, 0, 0}, {random.decades(0.5, 2.5), random.uniform(0, 1)}}};
  p.network.links = {{0, 1, {random.decades(0.5, 2), random.uniform(0.5, 1.6)}}};
  p.initial.q.head<2>() << 1, random.decades(-4, -1.5);
  p.initial.v[0] = -speed;
  p.initial.q.tail(dimension) = random.vector(dimension, 1);
  p.initial.q[dimension] += 2;
  return {p, 3, 2, speed};
}

// Masses with springs between most of them, thrown through each other.
Hard folding_net(Random& random) {
  const int dimension = random.uniform(0, 1) < 0.5 ? 2 : 3;
  const int nodes = static_cast<int>(random.uniform(2, 6));
  Problem p{{.dimension = dimension, .node_mass = Vec(nodes)},
            {0, random.vector(nodes * dimension, 2), Vec(nodes * dimension)}};
  const double speed = random.decades(0.5, 1.3);
  p.initial.v = random.vector(nodes * dimension, speed);
  const auto law = [&] { return SpringLaw{random.decades(0.5, 1.7), random.uniform(0.5, 4)}; };
  p.network.anchors = {{0, {0, 0, 0}, law()}, {1, {1, 0, 0}, law()}};
  for (int i = 0; i < nodes; ++i) {
    p.network.node_mass[i] = random.decades(-1, 0.5);
    for (int j = 0; j < i; ++j) {
      if (j + 1 == i || random.uniform(0, 1) < 0.6) p.network.links.push_back({j, i, law()});
    }
  }
  return {p, random.uniform(1, 3), 4, speed};
}

double distance_of_places(const State& a, const State& b) { return distance(a.q, b.q); }

}  // namespace

BOOST_AUTO_TEST_CASE(between_the_steps_of_hard_motions_states_are_as_accurate_as_their_ends) {
  Random random{std::mt19937(54)};
  constexpr int looks = 150;
  for (int trial = 0; trial < 24; ++trial) {
    const Hard hard = trial % 2 == 0 ? near_miss(random) : folding_net(random);
    const auto system = make_mass_spring(hard.problem.network);
    Film exact, seen;
    for (int i = 1; i < looks; ++i) {
      exact.times.push_back((i + 0.4 * std::fmod(0.618 * i, 1)) / looks * hard.until);
    }
    seen.times = exact.times;
    // Each state is the end of separate steps; another method says whether it can be known.
    const auto go = [&](const Method& method, double rtol, const Observer& observer) {
      const Options options{.rtol = rtol, .length = hard.length, .speed = hard.speed};
      return run(method, *system, hard.problem.initial, hard.until, options, observer);
    };
    const State end = go(method_named("dprkn12"), 1e-13, exact.observer()).state;
    if (distance_of_places(end, go(method_named("dprkn8"), 1e-13, {}).state) > 1e-7) continue;
    for (const Method& method : methods_of(Knob::rtol)) {
      const bool is_slow = method.order < 5 || method.is(Trait::implicit);
      for (const double rtol : {1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10}) {
        if (is_slow && rtol < 1e-5) continue;
        BOOST_TEST_CONTEXT(method.name << " at " << rtol << " in trial " << trial) {
          seen.seen.clear();
          const Run r = go(method, rtol, seen.observer());
          BOOST_TEST_REQUIRE(r.summary.message == "");
          double worst = 0;
          for (std::size_t i = 0; i < seen.seen.size(); ++i) {
            worst = std::max(worst, distance_of_places(seen.seen[i], exact.seen[i]));
          }
          // Errors on the way are not those at the end, but no tens of times larger, where a
          // polynomial that leaves the motion errs by metres.
          const double at_end = distance_of_places(r.state, end);
          BOOST_TEST(worst <= 20 * std::max(at_end, rtol * hard.length));
          if (!method.is(Trait::interpolates)) continue;
          BOOST_TEST(same(r.state, go(method, rtol, {}).state));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
