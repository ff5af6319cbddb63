#include "qddot/measure/reference/reference_rounding.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "qddot/measure/motion/modal_shares.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

double reach(const PartScale& part) { return std::max(part.extent, part.displacement); }

// A vector over the unknowns: each entry is `of` the part that the unknown belongs to.
template <class Of>
Vec by_unknown(const Model& scene, const Scales& scales, const Of& of) {
  Vec all = Vec::Zero(scene.system().size());
  Index at = 0;
  std::size_t part = 0;
  for (const Index n : scene.unknowns_by_part()) {
    all.segment(at, n).setConstant(of(scales.parts[part++]));
    at += n;
  }
  return all;
}

}  // namespace

State displaced_start(const Model& scene, const Scales& scales, double part) {
  State start = scene.initial();
  const Vec lengths = by_unknown(scene, scales, reach);
  const Vec speeds = by_unknown(scene, scales, [](const PartScale& own) { return own.speed; });
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-part, part);
  for (Index i = 0; i < start.q.size(); ++i) start.q[i] += lengths[i] * share(random);
  for (Index i = 0; i < start.v.size(); ++i) start.v[i] += speeds[i] * share(random);
  return start;
}

RoundingRun::RoundingRun(const Model& scene, const Solution& composed, double until, double seconds)
    : scene_(scene),
      path_(composed.path),
      scales_(composed.scales),
      knob_(composed.knob),
      steps_(until / composed.knob),
      start_(displaced_start(scene, scales_, machine_epsilon)) {
  // Masses and stiffnesses are rounded too. If all frequencies change by one rounding, each state
  // comes early or late by one rounding of the time.
  moved_ = composition(scene, start_, until * (1 + machine_epsilon), knob_, seconds);
  if (!moved_) return;
  effect_ = errors_between(scene, moved_->end, composed.end, 0, scales_);
  const State& initial = scene.initial();
  const double kinetic = scene.kinetic(initial), potential = scene.potential(initial);
  effect_.energy =
      errors_between(scene, start_, start_, scene.energy(initial), scales_).energy +
      (scales_.kinetic > 0 ? machine_epsilon * (kinetic + std::abs(potential)) / scales_.kinetic
                           : 0);
  const Vec lengths = by_unknown(scene, scales_, reach);
  for (Index i = 0; i < lengths.size(); ++i) {
    if (lengths[i] == 0) continue;
    growth_ = std::max(
        growth_, std::abs(moved_->end.q[i] - composed.end.q[i]) / (machine_epsilon * lengths[i]));
  }
}

bool RoundingRun::explains(double change) const {
  return !moved_ || change <= 10 * std::sqrt(steps_) * worse(effect_);
}

void RoundingRun::tell(Reference& reference) const {
  if (!moved_ || growth_ == 0) return;
  reference.perturbation_growth = growth_;
  reference.rounding_effect = effect_.position;
  std::vector<double> times, differences;
  const auto compare = [&](const State& one, const State& other) {
    times.push_back(one.t);
    differences.push_back(errors_between(scene_, one, other, 0, scales_).position);
  };
  compare(scene_.initial(), start_);
  for (std::size_t i = 0; i < moved_->path.size(); ++i) compare(path_[i], moved_->path[i]);
  const Divergence parting = divergence(times, differences);
  reference.horizon = parting.horizon;
  reference.lyapunov = parting.lyapunov;
}

std::optional<OutOfSymmetry> out_of_symmetry(const Scene& start, const Model& scene,
                                             const Solution& composed, double until,
                                             double seconds) {
  const Model drawn(start, Reductions().without(Reduction::dimension).without(Reduction::mirror));
  Scales scales;
  extend(scales, drawn, drawn.initial());
  // A node that starts at the origin has no coordinate to round; its displacement is rounded
  // instead.
  for (PartScale& part : scales.parts) {
    if (part.extent == 0) part.displacement = composed.scales.displacement;
  }
  const State pushed = displaced_start(drawn, scales, machine_epsilon);
  const auto moved = composition(drawn, pushed, until, composed.knob, seconds);
  if (!moved) return {};
  std::vector<double> times, differences;
  const auto compare = [&](const State& symmetric, const State& other) {
    times.push_back(symmetric.t);
    differences.push_back(
        position_error(drawn.expand(other), scene.expand(symmetric), composed.scales));
  };
  compare(scene.initial(), pushed);
  for (std::size_t i = 0; i < moved->path.size(); ++i) compare(composed.path[i], moved->path[i]);
  const Divergence parting = divergence(times, differences);
  return OutOfSymmetry{differences.back(), parting.horizon, parting.lyapunov};
}

void measure_shares(Reference& reference, const Model& scene, const Solution& composed,
                    double until, double seconds) {
  const auto modes = ModalShares::at_equilibrium(scene);
  if (!modes) return;
  const auto other =
      composition(scene, displaced_start(scene, composed.scales, std::sqrt(machine_epsilon)), until,
                  composed.knob, seconds);
  if (!other) return;
  reference.modal_shares = modes->mean(composed.path);
  reference.modal_shares_floor = total_variation(reference.modal_shares, modes->mean(other->path));
}

}  // namespace qddot::inline measure
