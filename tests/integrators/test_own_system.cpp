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
// Vibrations of 17 rad/s and 0.05 m give relative errors of (h w) w t / 2 at order 1. At order 2
// they are (h w)^2 w t / 12.
double allowed(const Method& method) { return method.order == 1 ? 2e-2 : 2e-3; }

// Runs all methods, on one chain or several side by side: each ends at the reference, or is refused
// with what expected(method) says.
template <class Expected>
void run_all(const System& system, const Expected& expected) {
  const auto for_each_chain = [copies = system.size() / 8](const State& s) {
    return State{s.t, s.q.replicate(copies, 1), s.v.replicate(copies, 1)};
  };
  const State begin = for_each_chain(start()), end = for_each_chain(reference());
  for (const Method& method : unconstrained_methods()) {
    BOOST_TEST_CONTEXT(method.name) {
      const Outcome outcome = expected(method);
      const Run r = run(method, system, begin, until, fine(method));
      BOOST_TEST(name(r.summary.outcome) == name(outcome));
      BOOST_TEST(applies_to(method, system) == (outcome == Outcome::reached_end));
      if (outcome == Outcome::reached_end) {
        BOOST_TEST(r.state.t == until);
        BOOST_TEST(distance(r.state, end) < allowed(method));
      } else {
        BOOST_TEST(r.summary.message == advice(outcome));
        BOOST_TEST(same(r.state, begin));
        BOOST_TEST(r.summary.counts == Counts{});
      }
    }
  }
}

template <class... Chains>
BlockDiagonalSystem side_by_side() {
  std::vector<std::unique_ptr<System>> blocks;
  (blocks.push_back(std::make_unique<Chains>()), ...);
  return BlockDiagonalSystem(std::move(blocks));
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

BOOST_AUTO_TEST_CASE(it_is_run_by_every_method_that_needs_no_more_than_it_offers) {
  run_all(Chain(), without_stiffness);
  run_all(WithGradient<Chain>(), without_stiffness);  // which does not stand for K
  run_all(ChainWithStiffness(), with_stiffness);
  run_all(DividedChain(), with_split);
}

// A system whose V must not be evaluated.
template <class Base>
class WithoutPotential final : public Base {
 public:
  bool has_potential() const override { return false; }
  double potential(const At&) const override { throw std::logic_error("V was asked for"); }
};

BOOST_AUTO_TEST_CASE(with_f_alone_its_energy_is_not_known) {
  const auto without = [](Outcome (*expected)(const Method&)) {
    return [=](const Method& method) {
      return method.asks(Need::potential) ? Outcome::no_potential : expected(method);
    };
  };
  run_all(WithoutPotential<Chain>(), without(without_stiffness));
  run_all(WithoutPotential<ChainWithStiffness>(), without(with_stiffness));
  const Run grown = run(method_named("explicit_euler"), WithoutPotential<Chain>(), start(), 20,
                        {.step_size = 1e-2});
  BOOST_TEST(grown.summary.energy_growth == 1);
  BOOST_TEST(side_by_side<ChainWithStiffness>().has_potential());
  const auto half = side_by_side<ChainWithStiffness, WithoutPotential<ChainWithStiffness>>();
  BOOST_TEST(!half.has_potential());
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
  BOOST_TEST(smallest_eigenvalue(matrix) < 0);
  for (const char* method : {"implicit_euler", "bdf2", "trbdf2"}) {
    BOOST_TEST_CONTEXT(method) {
      const Run r = run(method_named(method), chain, compressed, 1, {.step_size = h});
      BOOST_TEST(r.summary.message == "");
      BOOST_TEST(total_energy(chain, r.state) <= total_energy(chain, compressed));
    }
  }
}

BOOST_DATA_TEST_CASE(massless_nodes_without_k_are_refused_by_all, unconstrained_methods(), method) {
  Vec mass = Vec::Ones(8);
  mass[2] = mass[3] = 0;
  const Chain chain(mass);
  const Run r = run(method, chain, start(), until, fine(method));
  const Outcome expected =
      method.is(Trait::accepts_massless) ? Outcome::no_stiffness : Outcome::singular_mass;
  BOOST_TEST(name(r.summary.outcome) == name(expected));
  BOOST_TEST(r.summary.message == advice(expected));
}

BOOST_AUTO_TEST_CASE(of_two_chains_side_by_side_both_need_what_the_method_needs) {
  run_all(side_by_side<ChainWithStiffness, Chain>(), without_stiffness);
  run_all(side_by_side<ChainWithStiffness, ChainWithStiffness>(), with_stiffness);
}

BOOST_AUTO_TEST_SUITE_END()
