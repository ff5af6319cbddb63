#include "qddot/measure/reference/reference_rounding.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/measure/motion/modal_shares.hpp"
#include "qddot/measure/motion/pushed_start.hpp"
#include "qddot/measure/motion/rest.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

const double half_the_digits = 1 / std::sqrt(machine_epsilon);  // in roundings
// Regular motions' differences may grow by some thousands (see exponential_growth).
constexpr double regular_growth = 1000;
// A frequency is the root of a quotient. A term of V has a root, a difference, a square, a product.
constexpr double roundings_of_frequency = 2, roundings_of_energy = 4;

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

// Whether the unknowns of both, which are reduced by no symmetry, are those of the same nodes.
bool are_alike(const Model& one, const Model& other) {
  const auto reduction = [](const Finding& finding) { return finding.reduction; };
  return std::ranges::equal(one.findings(), other.findings(), {}, reduction, reduction) &&
         one.unknowns_by_part() == other.unknowns_by_part();
}

}  // namespace

bool is_reduced_by_symmetry(const Model& scene) {
  return std::ranges::any_of(scene.findings(), [](const Finding& finding) {
    return finding.reduction == Reduction::dimension || finding.reduction == Reduction::mirror;
  });
}

RoundingRun::RoundingRun(const Model& scene, const Solution& composed, double until, double seconds,
                         const Scene* drawn)
    : scene_(scene),
      path_(composed.path),
      scales_(composed.scales),
      knob_(composed.knob),
      steps_(until / composed.knob) {
  Scales reaching = scales_;
  if (drawn) reach_to_pins(reaching, *drawn);
  start_ = pushed_start(scene, reaching);
  for (const std::uint32_t seed : {1, 2, 3}) {
    if (!repeat(composed, reaching, seed, until, seconds, drawn)) break;
    // A single push may miss the direction in which errors grow.
    if (growth_ < regular_growth || worse(effect_) > far_apart) break;
  }
  if (!moved_) return;
  const State& initial = scene.initial();
  const double kinetic = scene.kinetic(initial), potential = scene.potential(initial);
  effect_.energy = errors_between(scene, start_, start_, scene.energy(initial), scales_).energy +
                   (scales_.kinetic > 0 ? roundings_of_energy * machine_epsilon *
                                              (kinetic + std::abs(potential)) / scales_.kinetic
                                        : 0);
}

bool RoundingRun::repeat(const Solution& composed, const Scales& reaching, std::uint32_t seed,
                         double until, double seconds, const Scene* drawn) {
  // If pins are pushed as well, forces change as they do by rounding.
  std::optional<Model> pushed;
  if (drawn && !is_reduced_by_symmetry(scene_))
    pushed.emplace(pushed_scene(*drawn, reaching, {.seed = seed}));
  const bool is_alike = pushed && are_alike(*pushed, scene_);
  const State start = is_alike ? pushed->initial() : pushed_start(scene_, reaching, {.seed = seed});
  // If all frequencies change by some roundings, each state comes early or late by as many of the
  // time. A longer end alone would be taken for the same one, as steps end beside it.
  constexpr double longer = 1 + roundings_of_frequency * machine_epsilon;
  auto moved =
      composition(is_alike ? *pushed : scene_, start, until * longer, knob_ * longer, seconds);
  if (!moved) return false;
  const Errors effect = errors_between(scene_, moved->end, composed.end, 0, scales_);
  const Vec lengths = by_unknown(scene_, reaching, reach);
  for (Index i = 0; i < lengths.size(); ++i) {
    if (lengths[i] == 0) continue;
    growth_ = std::max(
        growth_, std::abs(moved->end.q[i] - composed.end.q[i]) / (machine_epsilon * lengths[i]));
  }
  if (!moved_ || worse(effect) > worse(effect_)) {
    start_ = start;
    moved_ = std::move(moved);
  }
  effect_ = larger(effect_, effect);
  return true;
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
  const auto as_drawn = Reductions().without(Reduction::dimension).without(Reduction::mirror);
  const Model drawn(start, as_drawn);
  Scales scales;
  extend(scales, drawn, drawn.initial());
  reach_to_pins(scales, start);
  // A node that starts at the origin has no coordinate to round; its displacement is rounded
  // instead.
  for (PartScale& part : scales.parts) {
    if (part.extent == 0) part.displacement = composed.scales.displacement;
  }
  const Model moving(pushed_scene(start, scales), as_drawn);
  const State& pushed = moving.initial();
  const auto moved = composition(moving, pushed, until, composed.knob, seconds);
  if (!moved) return {};
  std::vector<double> times, differences;
  const auto compare = [&](const State& symmetric, const State& other) {
    times.push_back(symmetric.t);
    differences.push_back(
        position_error(moving.expand(other), scene.expand(symmetric), composed.scales));
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
      composition(scene, pushed_start(scene, composed.scales, {.roundings = half_the_digits}),
                  until, composed.knob, seconds);
  if (!other) return;
  reference.modal_shares = modes->mean(composed.path);
  reference.modal_shares_floor = total_variation(reference.modal_shares, modes->mean(other->path));
}

}  // namespace qddot::inline measure
