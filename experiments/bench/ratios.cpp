#include "experiments/bench/ratios.hpp"

#include <algorithm>

namespace qddot::bench {
namespace {

// The fastest of some peers, all with one f.
Ratio ratio_of(const std::vector<Sweep>& sweeps, bool smallest, double accuracy, double limit,
               const std::function<bool(const Sweep&)>& theirs) {
  const auto ours = [&](const Sweep& s) { return s.is_ours && s.is_smallest == smallest; };
  const bool was_cut = std::ranges::any_of(sweeps, [&](const Sweep& s) {
    return theirs(s) && s.points.back().outcome == Outcome::over_budget;
  });
  Ratio ratio{};
  ratio.accuracy = accuracy;
  ratio.theirs = fastest(sweeps, accuracy, theirs);
  if (ratio.theirs) {
    ratio.ours = fastest(sweeps, ratio.theirs->error, ours);
    if (ratio.ours) ratio.ratio = ratio.theirs->seconds / ratio.ours->seconds;
  } else if (was_cut) {
    ratio.is_bound = true;
    ratio.ours = fastest(sweeps, accuracy, ours);
    if (ratio.ours) ratio.ratio = limit / ratio.ours->seconds;
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
      const bool reaches = point.is_good() && point.error <= error;
      if (reaches && (!best || point.seconds < best->seconds)) best = &point;
    }
  }
  return best;
}

std::vector<Ratio> ratios(const std::vector<Sweep>& sweeps, bool smallest,
                          const std::vector<double>& accuracies, double limit) {
  std::vector<Ratio> all;
  const auto add = [&](const std::string& peer, const std::string& force, const auto& theirs) {
    for (const double accuracy : accuracies) {
      all.push_back(ratio_of(sweeps, smallest, accuracy, limit, theirs));
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
