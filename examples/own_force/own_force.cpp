// A force law of one's own: Duffing's oscillators, V = q^2/2 + q^4/4 each, by an explicit method.
#include <cstdio>
#include <memory>
#include <qddot/qddot.hpp>
#include <utility>
#include <vector>

class Duffing final : public qddot::System {
 public:
  explicit Duffing(qddot::Index n) : System(qddot::Vec::Ones(n)) {}  // the masses [kg]
  double potential(const qddot::At& at) const override {
    return at.q.squaredNorm() / 2 + at.q.array().pow(4).sum() / 4;
  }
  void force(const qddot::At& at, qddot::MutableVec f) const override {
    f = -at.q - at.q.array().cube().matrix();
  }
};

int main() {
  const auto system = std::make_shared<const Duffing>(1);
  const qddot::State start{0, qddot::Vec::Ones(1), qddot::Vec::Zero(1)};  // t, q, v
  const int dimension = 1;                                                // coordinates of a node
  qddot::Simulation run(system, start, dimension, qddot::method("dprkn8"), {.rtol = 1e-10});
  const qddot::Summary summary = run.advance(100);
  std::printf("q(%g s) = %.9f m\n", summary.t_reached, run.state().q[0]);

  // K by differences of f. The list has the pairs of unknowns whose forces depend on each other; an
  // unknown and itself need not be named.
  const auto stiff = std::make_shared<const qddot::DifferencedStiffness>(
      system, std::vector<std::pair<qddot::Index, qddot::Index>>{});
  qddot::Simulation implicit(stiff, start, dimension, qddot::method("implicit_midpoint"),
                             {.step_size = 1e-2});
  implicit.advance(1);
  const qddot::Answer sure = qddot::solve({stiff, start, dimension}, 10, {.accuracy = 1e-6});
  std::printf("%s: error at most %.1e\n", sure.method->name.c_str(), sure.error_estimate);
}
