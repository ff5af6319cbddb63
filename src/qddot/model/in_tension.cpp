#include "qddot/model/in_tension.hpp"

namespace qddot {
namespace {

// The samples of one turn of a vibration. Between two of them it is lower than at both by at most
// a part of 1e-3 of its amplitude.
constexpr int samples_a_turn = 72;

}  // namespace

Swing::Swing(const LengthMotion& from, const LengthMotion& to, double w, double h)
    : turn_(h * w),
      first_(from.length),
      last_(to.length),
      middle_(from.length + from.acceleration / (w * w)),
      slope_(to.length + to.acceleration / (w * w) - middle_),
      cosine_(first_ - middle_) {
  const double common = (from.rate + to.rate) / 2 - (last_ - first_) / h;
  const double across = std::sqrt(from.turning * from.length);
  const double doubtful = std::min(h * from.turning, across / 2);
  rate_ = (from.rate - std::clamp(common, -doubtful, doubtful)) / w;
}

std::optional<double> Swing::first_slack(double bound) const {
  if (first_ < bound) return 0;
  if (const auto resting = first_slack(bound, 0, std::min(turn_, 2 * M_PI))) return resting;
  if (const auto moving = first_slack(bound, slope_, turn_)) return moving;
  return last_ < bound ? std::optional(1.0) : std::nullopt;
}

// The same if the middle moves by `slope` in the step, up to a phase.
std::optional<double> Swing::first_slack(double bound, double slope, double last_phase) const {
  const double sine = rate_ - slope / turn_, amplitude = std::hypot(cosine_, sine);
  const double last_middle = middle_ + slope * last_phase / turn_;
  if (std::min(middle_, last_middle) - amplitude >= bound) return {};
  const double turn = std::min(last_phase, 2 * M_PI);
  for (int i = 1; i <= samples_a_turn; ++i) {
    const double phase = turn * i / samples_a_turn, s = phase / turn_;
    const double length = middle_ + slope * s + cosine_ * std::cos(phase) + sine * std::sin(phase);
    if (length < bound) return s;
  }
  // Later turns are as high as the first one, but for their middle.
  if (last_phase > turn && last_middle - amplitude < bound) {
    return std::clamp((bound - middle_ + amplitude) / slope, turn / turn_, 1.0);
  }
  return {};
}

}  // namespace qddot
