#include "qddot/analysis/damped_step.hpp"

#include <cmath>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/model/capabilities.hpp"

namespace qddot {
namespace {

constexpr int most_iterations = 60;
constexpr double resolved = 1e-5;

// A system whose K is that of another with `rate` C taken away.
class Stiffened final : public System {
 public:
  Stiffened(const System& system, double rate)
      : System(Vec(system.mass())), system_(system), rate_(rate) {}

  double potential(const At& at) const override { return system_.potential({at.t, at.q}); }
  void force(const At& at, MutableVec f) const override { system_.force({at.t, at.q}, f); }
  const SymmetricMatrix& stiffness_pattern() const override { return system_.stiffness_pattern(); }
  void stiffness(const At& at, SymmetricMatrix& k) const override {
    system_.stiffness({at.t, at.q}, k);
    SymmetricMatrix c = k;
    system_.damping()->damping_matrix(at, c);
    k.coeffs() -= rate_ * c.coeffs();
  }

 private:
  const System& system_;
  double rate_;  // [1/s]
};

}  // namespace

double damped_step_limit(const System& system, const Vec& q, double lag) {
  double h = 2 / quick_frequency(system, q);
  if (!system.damping()) return h;
  // Without springs that vibrate, any long step begins the iteration.
  if (!std::isfinite(h)) h = 1e6;
  for (int i = 0; i < most_iterations; ++i) {
    const double last = h;
    h = 2 / quick_frequency(Stiffened(system, 2 * lag / h), q);
    if (last - h <= resolved * h) break;
  }
  return h;
}

}  // namespace qddot
