// A force law of one's own: Duffing's oscillators, V = q^2/2 + q^4/4 each, by an explicit method.
#include <cstdio>
#include <memory>
#include <qddot/qddot.hpp>

class Duffing final : public qddot::System {
 public:
  explicit Duffing(qddot::Index n) : System(qddot::Vec::Ones(n)) {}  // the masses [kg]
  double potential(const qddot::ConstVec& q) const override {
    return q.squaredNorm() / 2 + q.array().pow(4).sum() / 4;
  }
  void force(const qddot::ConstVec& q, qddot::MutableVec f) const override {
    f = -q - q.array().cube().matrix();
  }
};

int main() {
  const auto system = std::make_shared<const Duffing>(1);
  const qddot::State start{0, qddot::Vec::Ones(1), qddot::Vec::Zero(1)};  // t, q, v
  qddot::Simulation run(system, start, 1, qddot::method("dprkn8"), {.rtol = 1e-10});
  const qddot::Summary summary = run.advance(100);
  std::printf("q(%g s) = %.9f m\n", summary.t_reached, run.state().q[0]);
}
