// The bound of what the modes of a small motion leave out: it holds, it is not idle, and it grows
// where theory says, on oscillators with cubic and quartic energies.
#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include "qddot/analysis/linear_motion.hpp"
#include "qddot/analysis/neglected_forces.hpp"
#include "qddot/model/linearized_system.hpp"

BOOST_AUTO_TEST_SUITE(neglected_forces)

using namespace qddot;

namespace {

// Two masses of 1 kg: V = (w1^2 y1^2 + w2^2 y2^2)/2 + c y1^2 y2 + b (y1^4 + y2^4)/4.
class Coupled final : public System {
 public:
  Coupled(double w1, double w2, double c, double b)
      : System(Vec::Ones(2)), w1_(w1), w2_(w2), c_(c), b_(b), pattern_(2, 2) {
    for (int j = 0; j < 2; ++j) {
      for (int i = j; i < 2; ++i) pattern_.insert(i, j) = 0;
    }
    pattern_.makeCompressed();
  }
  double potential(const At& at) const override {
    const double y1 = at.q[0], y2 = at.q[1];
    return (w1_ * w1_ * y1 * y1 + w2_ * w2_ * y2 * y2) / 2 + c_ * y1 * y1 * y2 +
           b_ * (std::pow(y1, 4) + std::pow(y2, 4)) / 4;
  }
  void force(const At& at, MutableVec f) const override {
    const double y1 = at.q[0], y2 = at.q[1];
    f[0] = -w1_ * w1_ * y1 - 2 * c_ * y1 * y2 - b_ * y1 * y1 * y1;
    f[1] = -w2_ * w2_ * y2 - c_ * y1 * y1 - b_ * y2 * y2 * y2;
  }
  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  void stiffness(const At& at, SymmetricMatrix& k) const override {
    const double y1 = at.q[0], y2 = at.q[1];
    k.coeffRef(0, 0) = -w1_ * w1_ - 2 * c_ * y2 - 3 * b_ * y1 * y1;
    k.coeffRef(1, 0) = -2 * c_ * y1;
    k.coeffRef(1, 1) = -w2_ * w2_ - 3 * b_ * y2 * y2;
  }

 private:
  double w1_, w2_, c_, b_;
  SymmetricMatrix pattern_;
};

// The largest distance of the motion from the linear one, in each unknown, by Runge and Kutta's
// method with steps whose error is far below it; and displacements on the way.
struct Comparison {
  Vec distance = Vec::Zero(2);
  std::vector<Vec> seen{};
};
Comparison compared(const System& system, const State& start, double until) {
  const auto linear = linearized(system, Vec::Zero(2));
  const LinearMotion modes(*linear);
  constexpr int steps_a_second = 200;
  const int steps = static_cast<int>(until * steps_a_second);
  const double h = until / steps;
  Vec q = start.q, v = start.v, f(2);
  const auto acceleration = [&](const Vec& x) -> Vec {
    system.force(x, f);
    return f;
  };
  Comparison result;
  for (int i = 1; i <= steps; ++i) {
    const Vec a1 = acceleration(q), v1 = v;
    const Vec v2 = v + h / 2 * a1, a2 = acceleration(q + h / 2 * v1);
    const Vec v3 = v + h / 2 * a2, a3 = acceleration(q + h / 2 * v2);
    const Vec v4 = v + h * a3, a4 = acceleration(q + h * v3);
    q += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    if (i % 7 != 0) continue;
    const State there = modes.after(start, i * h);
    result.distance = result.distance.cwiseMax((q - there.q).cwiseAbs());
    if (i % 77 == 0) result.seen.push_back(there.q);
  }
  return result;
}

Vec bound(const System& system, const State& start, const std::vector<Vec>& seen, double until) {
  const Vec middle = Vec::Zero(2);
  const double feedback = feedback_rate(system, middle, seen, 1);
  BOOST_TEST(until * feedback <= 2);
  return neglected_displacement({system, middle, start, seen, until, 1}, feedback, 0);
}

}  // namespace

// Products of two modes are seen one by one: with a few of them the bound is not far above.
BOOST_AUTO_TEST_CASE(the_second_order_is_bounded_closely) {
  const State start{0, Vec{{1e-5, 0}}, Vec{{0, 1e-6}}};
  for (const double w2 : {0.7, 1.3, 2.0, 2.1, 5.0}) {
    const Coupled system(1, w2, 3, 0);
    for (const double until : {20., 200.}) {
      const auto [distance, seen] = compared(system, start, until);
      const Vec most = bound(system, start, seen, until);
      for (Index i = 0; i < 2; ++i) {
        BOOST_TEST(distance[i] <= most[i], "w2 " << w2 << ", until " << until);
        // A beat that has just begun, and sums of amplitudes in place of their phases.
        BOOST_TEST(most[i] <= 12 * distance[i], "w2 " << w2 << ", until " << until);
      }
    }
  }
}

// At w2 = 2 w1 the square of the first mode drives the second, whose answer grows with the time.
BOOST_AUTO_TEST_CASE(a_resonance_grows_and_others_do_not) {
  const State start{0, Vec{{1e-6, 0}}, Vec{{0, 0}}};
  const auto growth = [&](double w2) {
    const Coupled system(1, w2, 3, 0);
    const std::vector<Vec> seen = {Vec{{1e-6, 0}}};
    return bound(system, start, seen, 400)[1] / bound(system, start, seen, 200)[1];
  };
  BOOST_TEST(std::abs(growth(2) - 2) < 0.02);
  BOOST_TEST(std::abs(growth(2.5) - 1) < 0.02);
}

// Quartic energies change frequencies: the distance grows with the time, and is of third order.
BOOST_AUTO_TEST_CASE(the_third_order_is_bounded) {
  for (const double size : {1e-3, 1e-5}) {
    const State start{0, Vec{{size, -size / 3}}, Vec{{0, 0}}};
    const Coupled system(1, 2.3, 0, 5);
    const auto [distance, seen] = compared(system, start, 300);
    const Vec most = bound(system, start, seen, 300);
    BOOST_TEST((distance.array() <= most.array()).all());
    BOOST_TEST(most.maxCoeff() <= 20 * distance.maxCoeff());  // as if pushes never turned
  }
}

BOOST_AUTO_TEST_CASE(feedback_is_a_matrix_norm) {
  const double w1 = 1, w2 = 2.3, c = 3;
  const Coupled system(w1, w2, c, 0);
  const Vec u{{2e-3, -1e-3}};
  const Eigen::Matrix2d d{{-2 * c * u[1], -2 * c * u[0]}, {-2 * c * u[0], 0}};
  const Eigen::Matrix2d scaled = d * Eigen::Vector2d(1 / w1, 1 / w2).asDiagonal();
  const double norm = Eigen::JacobiSVD<Eigen::Matrix2d>(scaled).singularValues()[0];
  const double found = feedback_rate(system, Vec::Zero(2), {u, u / 2}, 1);
  BOOST_TEST(found >= norm);
  BOOST_TEST(found <= 1.11 * norm);
  // About a place where V falls along a line there is no bound.
  BOOST_TEST(std::isinf(feedback_rate(Coupled(1, 1, -1, 0), Vec{{0, -1}}, {u}, 1)) == false);
  BOOST_TEST(std::isinf(feedback_rate(Coupled(1, 1, -1, 0), Vec{{0, 1}}, {u}, 1)));
}

BOOST_AUTO_TEST_CASE(a_linearized_system_is_its_first_order) {
  const Coupled system(1, 1.7, 2, 4);
  const Vec place{{0.3, -0.2}}, u{{1e-4, 2e-4}};
  const auto linear = linearized(system, place);
  Vec f(2), g(2);
  system.force(Vec(place + u), f);
  linear->force(Vec(place + u), g);
  // Derivatives of K are some 10 to 20 N/m^2.
  BOOST_TEST((f - g).norm() < 20 * u.squaredNorm());
  BOOST_TEST(std::abs(system.potential(Vec(place + u)) - linear->potential(Vec(place + u))) <
             20 * std::pow(u.norm(), 3));
  BOOST_TEST(linear->stiffness_is_constant());
}

BOOST_AUTO_TEST_SUITE_END()
