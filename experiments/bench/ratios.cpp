#include "experiments/bench/ratios.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qddot::bench {
namespace {

bool reaches(const Measured& point, double error) {
  return point.is_good() && point.error <= error;
}

// The time [s] that a sweep spent without reaching the accuracy before it was over budget; infinite
// if it was not over budget.
double spent_in_vain(const Sweep& sweep, double accuracy) {
  const bool was_cut = sweep.points.back().outcome == Outcome::over_budget;
  const auto is_there = [&](const Measured& point) { return reaches(point, accuracy); };
  return was_cut && std::ranges::none_of(sweep.points, is_there)
             ? sweep.points.back().seconds
             : std::numeric_limits<double>::infinity();
}

// The fastest of some peers, all with one f.
Ratio ratio_of(const std::vector<Sweep>& sweeps, bool smallest, double accuracy,
               const std::function<bool(const Sweep&)>& theirs) {
  const auto ours = [&](const Sweep& s) { return s.is_ours && s.is_smallest == smallest; };
  double spent = std::numeric_limits<double>::infinity();
  for (const Sweep& sweep : sweeps) {
    if (theirs(sweep)) spent = std::min(spent, spent_in_vain(sweep, accuracy));
  }
  Ratio ratio{};
  ratio.accuracy = accuracy;
  const Measured* best = fastest(sweeps, accuracy, theirs);
  if (best && best->seconds <= spent) {
    ratio.theirs = best;
    ratio.ours = fastest(sweeps, best->error, ours);
    if (ratio.ours) ratio.ratio = best->seconds / ratio.ours->seconds;
  } else if (std::isfinite(spent)) {
    ratio.is_bound = true;
    ratio.ours = fastest(sweeps, accuracy, ours);
    if (ratio.ours) ratio.ratio = spent / ratio.ours->seconds;
  }
  return ratio;
}

}  // namespace

const Measured* fastest(const std::vector<Sweep>& sweeps, double error,
                        const std::function<bool(const Sweep&)>& counts) {
  const Measured* best = nullptr;
  for (const Sweep& sweep : sweeps) {
    if (!counts(sweep)) continue;
    for (const Measured& point : sweep.points) {
      if (reaches(point, error) && (!best || point.seconds < best->seconds)) best = &point;
    }
  }
  return best;
}

std::vector<Ratio> ratios(const std::vector<Sweep>& sweeps, bool smallest,
                          const std::vector<double>& accuracies) {
  std::vector<Ratio> all;
  const auto add = [&](const std::string& peer, const std::string& force, const auto& theirs) {
    for (const double accuracy : accuracies) {
      all.push_back(ratio_of(sweeps, smallest, accuracy, theirs));
      all.back().peer = peer;
      all.back().force = force;
    }
  };
  for (const Sweep& sweep : sweeps) {
    if (sweep.is_ours) continue;
    const Measured& any = sweep.points.front();
    add(any.solver, any.force, [&](const Sweep& s) { return &s == &sweep; });
  }
  for (const ForceKind kind : {ForceKind::plain, ForceKind::ours}) {
    const std::string force = force_name(kind);
    const auto is_theirs = [&](const Sweep& s) {
      return s.is_stock_implicit && s.points.front().force == force;
    };
    if (std::ranges::any_of(sweeps, is_theirs)) add("best of KLU", force, is_theirs);
  }
  return all;
}

}  // namespace qddot::bench
