#include "qddot/integrators/base/kick_drift.hpp"

#include <algorithm>
#include <cassert>

namespace qddot {

std::vector<double> mirrored(std::vector<double> half, std::size_t size) {
  assert(half.size() == (size + 1) / 2);
  for (std::size_t i = half.size(); i < size; ++i) half.push_back(half[size - 1 - i]);
  return half;
}

KickDrift::KickDrift(SystemRun& run, const Splitting& splitting)
    : Formula(run),
      splitting_(splitting),
      kicks_first_(splitting.kicks.size() > splitting.drifts.size()),
      q_(options().compensated, system().size()),
      v_(options().compensated, system().size()),
      f_(system().size()) {}

void KickDrift::begin(const State& state, State& x) {
  x = state;
  q_.restart();
  v_.restart();
  if (kicks_first_) force({state.t, state.q}, f_);
}

void KickDrift::kick(double size, State& state) {
  v_.add_quotient(state.v, size, f_, system().mass(), state.v);
}

void KickDrift::drift(double size, State& state) { q_.add_scaled(state.q, size, state.v, state.q); }

Outcome KickDrift::step(const State& now, double h, State& next) {
  const auto& [order, kicks, drifts] = splitting_;
  next.q = now.q;
  next.v = now.v;
  double t = now.t;
  for (std::size_t i = 0; i < std::min(kicks.size(), drifts.size()); ++i) {
    if (kicks_first_) kick(kicks[i] * h, next);
    drift(drifts[i] * h, next);
    t += drifts[i] * h;
    force({t, next.q}, f_);
    if (!kicks_first_) kick(kicks[i] * h, next);
  }
  if (kicks_first_) {
    kick(kicks.back() * h, next);
  } else {
    drift(drifts.back() * h, next);
  }
  return Outcome::reached_end;
}

std::unique_ptr<Stepper> create_splitting(SystemRun& run) {
  return std::make_unique<FixedSteps<KickDrift>>(run, *run.method().splitting);
}

}  // namespace qddot
