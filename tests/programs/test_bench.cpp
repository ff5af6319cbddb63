// Other people's solvers, each on a motion that is known in closed form: to its tolerance they all
// end where it ends, with either f.
#include <cmath>

#include <boost/test/unit_test.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/bench/comparison.hpp"
#include "tests/folder.hpp"

BOOST_AUTO_TEST_SUITE(bench)

using namespace qddot;
using namespace qddot::bench;

namespace {

// Two masses 1 m apart in space, one of them pinned, on a spring of zero rest length under gravity.
// The motion x'' = -w^2 (x - a) + g is an ellipse about a + g/w^2, w = 10/s.
constexpr double w = 10, until = 0.5;

Scene ellipse() {
  Scene scene{.name = "ellipse", .gravity = {0, 0, -9.81}, .until = until};
  scene.nodes = {{.position = {1, 2, 3}, .pinned = true},
                 {.position = {2, 2, 3}, .velocity = {0, 3, 1}, .mass = 0.25}};
  scene.springs = {{{0, 1}, {.stiffness = 0.25 * w * w}}};
  return scene;
}

Eigen::Vector3d exact_position() {
  const Scene scene = ellipse();
  const Eigen::Vector3d center = scene.nodes[0].position + scene.gravity / (w * w);
  return center + (scene.nodes[1].position - center) * std::cos(w * until) +
         scene.nodes[1].velocity * std::sin(w * until) / w;
}

}  // namespace

struct Given {
  Folder folder;
  Problem problem{ellipse(), ellipse(), until, folder.path(), nlohmann::json::object()};

  // The error of the run's end [m].
  double distance(Peer& peer, ForceKind force, double value) const {
    const Run run = peer.run(problem, force, value, 60);
    BOOST_TEST(name(run.outcome) == name(Outcome::reached_end), peer.name());
    return (run.end.q - exact_position()).norm();
  }
};

// Global errors of adaptive methods are the tolerance times a factor that grows with the length of
// the run, here less than a period. A factor of 1000 is far above all, and far below a wrong
// motion.
BOOST_FIXTURE_TEST_CASE(adaptive_peers_reach_the_exact_end, Given) {
  constexpr double rtol = 1e-8;
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(odeint_dopri5());
  peers.push_back(arkode_erk4());
  peers.push_back(stock_implicit("arkode_dirk4_klu"));
  peers.push_back(stock_implicit("cvode_bdf_klu"));
  if (has_scipy()) {
    for (const char* method : {"DOP853", "Radau", "BDF"}) peers.push_back(scipy(method, ""));
  }
  for (const auto& peer : peers) {
    for (const ForceKind force : peer->forces()) {
      BOOST_TEST(distance(*peer, force, rtol) < 1000 * rtol, peer->name() << force_name(force));
    }
  }
}

// McLachlan's method has order 4: half a step leaves a sixteenth of the error. The tolerance is a
// quarter at h w = 0.1, where the next term is some h w smaller.
BOOST_FIXTURE_TEST_CASE(mclachlan_converges_with_order_4, Given) {
  const auto peer = odeint_mclachlan();
  const double coarse = distance(*peer, ForceKind::plain, 0.01);
  const double fine = distance(*peer, ForceKind::plain, 0.005);
  BOOST_TEST(coarse / fine == 16, boost::test_tools::tolerance(0.25));
}

// Bullet's links are of order 1, and exact in the strain if the rest length is zero. Floats, 3 m
// from the origin, still have a smaller error at 2e-4 s.
BOOST_FIXTURE_TEST_CASE(bullet_converges_with_order_1, Given) {
  const auto peer = bullet();
  if (!peer) return;
  const double coarse = distance(*peer, ForceKind::its_own, 0.004);
  const double fine = distance(*peer, ForceKind::its_own, 0.001);
  BOOST_TEST(coarse / fine == 4, boost::test_tools::tolerance(0.25));
}

// A spring of 1 m stretched by a hundredth moves as x = 1 + 0.01 cos(w t). Bullet's law of the
// spring differs by the strain, a hundredth, and steps of h w = 0.01 by as much.
BOOST_AUTO_TEST_CASE(bullet_keeps_rest_lengths) {
  const auto peer = bullet();
  if (!peer) return;
  Scene scene{.name = "stretched", .until = until};
  scene.nodes = {{.pinned = true}, {.position = {1.01, 0, 0}, .mass = 0.25}};
  scene.springs = {{{0, 1}, {.stiffness = 0.25 * w * w, .rest_length = 1}}};
  const Folder folder;
  const Problem problem(scene, scene, until, folder.path(), nlohmann::json::object());
  const Run run = peer->run(problem, ForceKind::its_own, 0.001, 60);
  BOOST_TEST(std::abs(run.end.q[0] - (1 + 0.01 * std::cos(w * until))) < 0.05 * 0.01);
}

BOOST_FIXTURE_TEST_CASE(our_methods_run_on_either_system, Given) {
  for (const bool smallest : {true, false}) {
    const auto own = our_method("kahan_li8", smallest);
    // h w = 0.05, (h w)^8 = 4e-11.
    BOOST_TEST(distance(*own, ForceKind::ours, 0.005) < 1e-10);
  }
}

// The plain f and ours are the same sums in another order: some roundings of the largest force.
BOOST_AUTO_TEST_CASE(plain_and_our_accelerations_agree) {
  Scene scene = ellipse();
  scene.nodes.push_back({.position = {2, 3, 3}, .mass = 0.5});
  scene.springs.push_back({{1, 2}, {.stiffness = 30, .rest_length = 0.7, .quartic = 5}});
  scene.springs.push_back({{2, 0}, {.stiffness = 20, .rest_length = 0.5}});
  const Model reduced(scene, Reductions::only({Reduction::pins}));
  Acceleration plain(scene, reduced.system(), ForceKind::plain);
  Acceleration ours(scene, reduced.system(), ForceKind::ours);
  Vec a(6), b(6);
  plain(reduced.initial().q.data(), a.data());
  ours(reduced.initial().q.data(), b.data());
  BOOST_TEST((a - b).norm() < 1e-14 * a.norm());
  BOOST_TEST(plain.evaluations() == 1);
}

BOOST_FIXTURE_TEST_CASE(a_peer_out_of_time_says_so, Given) {
  const auto peer = odeint_mclachlan();
  const Run run = peer->run(problem, ForceKind::plain, 1e-9, 0.01);
  BOOST_TEST(name(run.outcome) == name(Outcome::over_budget));
  BOOST_TEST(run.seconds > 0);
}

// A peer of order 4 whose steps diverge where there are fewer than 41.
class Limited final : public Peer {
 public:
  static constexpr double limit = 41;

  Limited() : Peer("limited", Knob::step_size) {}
  std::vector<double> values(const Problem& problem) const override {
    return step_sizes(problem, 10, 2);
  }
  Run run(const Problem& problem, ForceKind force, double h, double seconds) override {
    const double steps = std::round(problem.until / h);
    Run run = our_method("kahan_li8", false)->run(problem, force, problem.until / 200, seconds);
    run.end.q[0] += 0.01 * std::pow(limit / steps, 4);
    if (steps < limit) run.outcome = Outcome::diverged;
    return run;
  }
};

// The limit is between two rungs that are 0.98 of each other, or neighbours; none is finer than the
// peer's own.
BOOST_FIXTURE_TEST_CASE(steps_are_closer_near_a_limit_whosever_they_are, Given) {
  Limited peer;
  std::vector<double> reported;
  const PeerLadder all = measure_ladder(peer, ForceKind::ours, problem, {.repeats = 1},
                                        [&](const std::string&, const auto& take) {
                                          const Measured point = take();
                                          reported.push_back(point.value);
                                          return point;
                                        });
  const auto values = peer.values(problem);
  BOOST_TEST(reported.size() == all.points.size());
  BOOST_TEST(all.points.size() > values.size());
  BOOST_TEST(all.points.back().value == values.back());
  BOOST_TEST(std::ranges::is_sorted(all.points, std::ranges::greater(), &Measured::value));
  const auto good = std::ranges::find_if(all.points, &Measured::is_good);
  BOOST_TEST_REQUIRE((good != all.points.begin() && good != all.points.end()));
  BOOST_TEST(std::round(until / good->value) == Limited::limit);
  BOOST_TEST(std::round(until / (good - 1)->value) == Limited::limit - 1);
}

// Ours is held to the error that the peer's run really has, and a run cut short gives a bound.
BOOST_AUTO_TEST_CASE(ratios_are_at_equal_or_better_error) {
  const auto point = [](double error, double seconds, Outcome outcome) {
    Measured p;
    p.error = error;
    p.seconds = seconds;
    p.outcome = outcome;
    return p;
  };
  constexpr auto good = Outcome::reached_end, cut = Outcome::over_budget;
  std::vector<PeerLadder> ladders(2);
  ladders[0].points = {point(1e-3, 1, good), point(1e-5, 6, good), point(0, 9, cut)};
  ladders[1].is_ours = ladders[1].is_smallest = true;
  ladders[1].points = {point(5e-5, 1, good), point(1e-5, 2, good), point(1e-7, 3, good)};
  const auto all = ratios(ladders, true, {1e-2, 1e-4, 1e-6, 1e-8});
  BOOST_TEST(all.size() == 4u);
  BOOST_TEST(all[0].ratio == 1.0 / 1.0);  // of 1e-3, for which the fastest of ours does
  BOOST_TEST(all[1].ratio == 6.0 / 2.0);  // of 1e-5, which is what theirs has
  BOOST_TEST(all[2].is_bound);
  BOOST_TEST(all[2].ratio == 9.0 / 3.0);
  BOOST_TEST(!all[3].is_known());  // none of ours gets there
}

BOOST_AUTO_TEST_SUITE_END()
