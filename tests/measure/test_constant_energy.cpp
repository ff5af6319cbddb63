#include <cmath>
#include <memory>

#include <boost/test/unit_test.hpp>

#include "qddot/measure/advice/advise.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/work_precision.hpp"

BOOST_AUTO_TEST_SUITE(constant_energy)

using namespace qddot;

namespace {

// x'' = -x - c x' + a cos(2 t), with a K so that all could be asked for.
class Forced final : public System {
 public:
  Forced(double damping, double amplitude)
      : System(Vec::Ones(1)), c_(damping), a_(amplitude), pattern_(1, 1) {
    pattern_.insert(0, 0) = 0;
    pattern_.makeCompressed();
  }
  double potential(const At& at) const override { return 0.5 * at.q[0] * at.q[0]; }
  void force(const At& at, MutableVec f) const override {
    f[0] = -at.q[0] - (c_ == 0 ? 0 : c_ * at.v[0]) + (a_ == 0 ? 0 : a_ * std::cos(2 * at.t));
  }
  bool is_conservative() const override { return c_ == 0; }
  bool is_autonomous() const override { return a_ == 0; }
  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  void stiffness(const At&, SymmetricMatrix& k) const override { k.coeffs()[0] = -1; }

 private:
  double c_, a_;
  SymmetricMatrix pattern_;
};

State start() { return {0, Vec::Ones(1), Vec::Zero(1)}; }

bool names_energy(const std::invalid_argument& error) {
  return std::string(error.what()).find("takes the energy for a constant") != std::string::npos;
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_takes_the_energy_for_a_constant_refuses_other_systems) {
  for (const auto& [c, a] : {std::pair(0.5, 0.0), {0.0, 0.3}, {0.5, 0.3}}) {
    const Model model(std::make_shared<Forced>(c, a), start(), 1);
    BOOST_CHECK_EXCEPTION(solve(model, 1, {.accuracy = 1e-3}), std::invalid_argument, names_energy);
    BOOST_CHECK_EXCEPTION(advise(model, 1, {1e-3}), std::invalid_argument, names_energy);
    BOOST_CHECK_EXCEPTION(make_reference(model, 1, 10), std::invalid_argument, names_energy);
    BOOST_CHECK_EXCEPTION(agreed_reference(model, 1, 1e-6, 10), std::invalid_argument,
                          names_energy);
    BOOST_CHECK_EXCEPTION(work_precision(model, 1), std::invalid_argument, names_energy);
  }
  const Model model(std::make_shared<Forced>(0, 0), start(), 1);
  BOOST_TEST(solve(model, 1, {.accuracy = 1e-3}).is_reached);
}

BOOST_AUTO_TEST_CASE(a_simulation_runs_them_by_a_method_that_takes_their_forces) {
  Simulation run(std::make_shared<Forced>(0.5, 0), start(), 1, method("rk4"), {.step_size = 1e-3});
  BOOST_TEST_REQUIRE((run.advance(2).outcome == Outcome::reached_end));
  const double w = std::sqrt(1 - 0.25 * 0.25), e = std::exp(-0.5);
  const double x = e * (std::cos(2 * w) + 0.25 / w * std::sin(2 * w));
  BOOST_TEST(std::abs(run.state().q[0] - x) < 1e-12);  // h^4 t
  BOOST_CHECK_THROW(Simulation(std::make_shared<Forced>(0.5, 0), start(), 1, method("verlet"),
                               {.step_size = 1e-3}),
                    std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
