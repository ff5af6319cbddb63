#include <stdexcept>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "qddot/model/block_diagonal_system.hpp"
#include "tests/integrators/own_system.hpp"
#include "tests/integrators/runs.hpp"

BOOST_AUTO_TEST_SUITE(own_system)

using namespace qddot;

namespace {

constexpr double until = 0.5;

State start() {
  return {0, Vec{{1, 0.1, 2, -0.1, 3.02, 0.05, 4, -0.1}},
          Vec{{0.5, -0.3, -0.2, 0.4, 0.3, 0.5, -0.6, 0.2}}};
}

const State& reference() {
  static const State end =
      run(method_named("dprkn12"), ChainWithStiffness(), start(), until, {.rtol = 1e-12}).state;
  return end;
}

// Steps and tolerances at which the method errs by far less than the chain moves.
Options fine(const Method& method) {
  return options_of(method, method.order == 1 ? 1e-4 : 1e-3, 1e-8);
}
// Vibrations of 17 rad/s and 0.05 m give relative errors of (h w) w t / 2 at order 1, and of (h
// w)^2 w t / 12 at order 2.
double allowed(const Method& method) { return method.order == 1 ? 2e-2 : 2e-3; }

// Runs all methods: each ends at the reference, or is refused with what expected(method) says.
template <class Expected>
void run_all(const System& system, const Expected& expected) {
  for (const Method& method : methods()) {
    BOOST_TEST_CONTEXT(method.name) {
      const Outcome outcome = expected(method);
      const Run r = run(method, system, start(), until, fine(method));
      BOOST_TEST(name(r.summary.outcome) == name(outcome));
      BOOST_TEST(applies_to(method, system) == (outcome == Outcome::reached_end));
      if (outcome == Outcome::reached_end) {
        BOOST_TEST(r.state.t == until);
        BOOST_TEST(distance(r.state, reference()) < allowed(method));
      } else {
        BOOST_TEST(r.summary.message == advice(outcome));
        BOOST_TEST(same(r.state, start()));
        BOOST_TEST(r.summary.counts == Counts{});
      }
    }
  }
}

Outcome without_stiffness(const Method& method) {
  if (method.asks(Need::stiffness)) return Outcome::no_stiffness;
  return method.asks(Need::laplacian) ? Outcome::no_laplacian : Outcome::reached_end;
}
Outcome with_split(const Method& method) {
  if (method.asks(Need::constant_stiffness)) return Outcome::stiffness_varies;
  return method.asks(Need::laplacian) ? Outcome::no_laplacian : Outcome::reached_end;
}
Outcome with_stiffness(const Method& method) {
  if (method.asks(Need::discrete_gradient)) return Outcome::no_discrete_gradient;
  return method.asks(Need::split_forces) ? Outcome::no_stiff_set : with_split(method);
}

}  // namespace

BOOST_AUTO_TEST_CASE(its_force_and_stiffness_are_the_derivatives_of_its_energy) {
  const ChainWithStiffness chain;
  const Vec q = start().q;
  const auto v = [&](const Vec& x) { return Vec::Constant(1, chain.potential(x)); };
  const auto f = [&](const Vec& x) { return force_at(chain, x); };
  // Differences over 1e-3 m err by h^4/30 of the fifth derivatives, which are some 12 13 14 15
  // 16 17.
  const Vec slope = finite_difference_jacobian(v, q, 1e-3).transpose();
  BOOST_TEST(distance(slope, -f(q)) < 1e-6);
  BOOST_TEST(distance(finite_difference_jacobian(f, q, 1e-3), dense(stiffness_at(chain, q))) <
             1e-5);
}

BOOST_AUTO_TEST_CASE(the_reference_is_one_and_the_chain_moves) {
  const State end =
      run(method_named("kahan_li8"), Chain(), start(), until, {.step_size = 1e-3}).state;
  BOOST_TEST(distance(end, reference()) < 1e-9);
  BOOST_TEST(distance(start().q, reference().q) > 0.05);
  BOOST_TEST(distance(start().v, reference().v) > 0.5);
}

BOOST_AUTO_TEST_CASE(with_v_and_f_alone_it_is_run_by_every_method_that_needs_no_k) {
  run_all(Chain(), without_stiffness);
}

// A system whose V must not be evaluated.
template <class Base>
class WithoutPotential final : public Base {
 public:
  bool has_potential() const override { return false; }
  double potential(const ConstVec&) const override { throw std::logic_error("V was asked for"); }
};

BOOST_AUTO_TEST_CASE(with_f_alone_it_is_run_by_the_same_methods_and_its_growth_is_not_known) {
  run_all(WithoutPotential<Chain>(), without_stiffness);
  run_all(WithoutPotential<ChainWithStiffness>(), with_stiffness);
  const Run grown = run(method_named("explicit_euler"), WithoutPotential<Chain>(), start(), 20,
                        {.step_size = 1e-2});
  BOOST_TEST(grown.summary.energy_growth == 1);
  std::vector<std::unique_ptr<System>> blocks;
  blocks.push_back(std::make_unique<ChainWithStiffness>());
  BOOST_TEST(BlockDiagonalSystem(std::move(blocks)).has_potential());
  blocks.clear();
  blocks.push_back(std::make_unique<ChainWithStiffness>());
  blocks.push_back(std::make_unique<WithoutPotential<ChainWithStiffness>>());
  BOOST_TEST(!BlockDiagonalSystem(std::move(blocks)).has_potential());
}

BOOST_AUTO_TEST_CASE(a_capability_does_not_stand_for_k) {
  run_all(WithGradient<Chain>(), without_stiffness);
}

BOOST_AUTO_TEST_CASE(with_k_it_is_run_by_every_method_that_needs_nothing_else) {
  run_all(ChainWithStiffness(), with_stiffness);
}

BOOST_AUTO_TEST_CASE(with_a_discrete_gradient_its_energy_can_be_kept) {
  const WithGradient<ChainWithStiffness> chain;
  run_all(chain, [](const Method& method) {
    return method.asks(Need::discrete_gradient) ? Outcome::reached_end : with_stiffness(method);
  });
  const State end =
      run(method_named("discrete_gradient"), chain, start(), 5, {.step_size = 0.02}).state;
  BOOST_TEST(std::abs(total_energy(chain, end) - total_energy(chain, start())) < 1e-8);
}

BOOST_AUTO_TEST_CASE(with_its_bonds_named_stiff_all_methods_run_that_take_forces_apart) {
  run_all(DividedChain(), with_split);
}

// Bonds of 0.8 m push so hard that -K is negative across them. The matrix of a step with all of K
// is indefinite, so that only a part of K is used.
BOOST_AUTO_TEST_CASE(a_compressed_chain_is_stepped_with_a_part_of_k) {
  const ChainWithStiffness chain;
  State compressed = start();
  compressed.v.setZero();
  compressed.q << 0.8, 0, 1.6, 0.001, 2.4, 0, 3.2, -0.001;
  constexpr double h = 0.05;
  const Eigen::MatrixXd matrix =
      Eigen::MatrixXd::Identity(8, 8) - h * h * dense(stiffness_at(chain, compressed.q));
  BOOST_TEST(matrix.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() < 0);
  for (const char* method : {"implicit_euler", "bdf2", "trbdf2"}) {
    BOOST_TEST_CONTEXT(method) {
      const Run r = run(method_named(method), chain, compressed, 1, {.step_size = h});
      BOOST_TEST(r.summary.message == "");
      BOOST_TEST(total_energy(chain, r.state) <= total_energy(chain, compressed));
    }
  }
}

BOOST_DATA_TEST_CASE(massless_nodes_without_k_are_refused_by_all, methods(), method) {
  Vec mass = Vec::Ones(8);
  mass[2] = mass[3] = 0;
  const Chain chain(mass);
  const Run r = run(method, chain, start(), until, fine(method));
  const Outcome expected =
      method.is(Trait::accepts_massless) ? Outcome::no_stiffness : Outcome::singular_mass;
  BOOST_TEST(name(r.summary.outcome) == name(expected));
}

BOOST_AUTO_TEST_CASE(of_two_chains_side_by_side_both_need_what_the_method_needs) {
  const auto two = [](bool both) {
    std::vector<std::unique_ptr<System>> blocks;
    blocks.push_back(std::make_unique<ChainWithStiffness>());
    if (both) {
      blocks.push_back(std::make_unique<ChainWithStiffness>());
    } else {
      blocks.push_back(std::make_unique<Chain>());
    }
    return std::make_unique<BlockDiagonalSystem>(std::move(blocks));
  };
  State both_start{0, Vec(16), Vec(16)};
  both_start.q << start().q, start().q;
  both_start.v << start().v, start().v;
  for (const bool both : {false, true}) {
    const auto system = two(both);
    for (const Method& method : methods()) {
      BOOST_TEST_CONTEXT(method.name << (both ? ", both with K" : "")) {
        const Outcome expected = both ? with_stiffness(method) : without_stiffness(method);
        const Run r = run(method, *system, both_start, until, fine(method));
        BOOST_TEST(name(r.summary.outcome) == name(expected));
        if (expected != Outcome::reached_end) continue;
        BOOST_TEST(distance(r.state.q.head(8), reference().q) < allowed(method));
        BOOST_TEST(distance(r.state.q.tail(8), reference().q) < allowed(method));
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
