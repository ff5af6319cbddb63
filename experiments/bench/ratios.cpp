#include "experiments/bench/ratios.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qddot::bench {
namespace {

bool reaches(const Measured& point, double error) {
  return point.is_good() && point.error <= error;
}

// The time [s] that a ladder spent without reaching the accuracy before it was over budget;
// infinite if it was not over budget.
double spent_in_vain(const PeerLadder& ladder, double accuracy) {
  const bool was_cut = ladder.points.back().outcome == Outcome::over_budget;
  const auto is_there = [&](const Measured& point) { return reaches(point, accuracy); };
  return was_cut && std::ranges::none_of(ladder.points, is_there)
             ? ladder.points.back().seconds
             : std::numeric_limits<double>::infinity();
}

// The fastest of some peers, all with one f.
Ratio ratio_of(const std::vector<PeerLadder>& ladders, bool smallest, double accuracy,
               const std::function<bool(const PeerLadder&)>& theirs) {
  const auto ours = [&](const PeerLadder& l) { return l.is_ours && l.is_smallest == smallest; };
  double spent = std::numeric_limits<double>::infinity();
  for (const PeerLadder& ladder : ladders) {
    if (theirs(ladder)) spent = std::min(spent, spent_in_vain(ladder, accuracy));
  }
  Ratio ratio{};
  ratio.accuracy = accuracy;
  const Measured* best = fastest(ladders, accuracy, theirs);
  if (best && best->seconds <= spent) {
    ratio.theirs = best;
    ratio.ours = fastest(ladders, best->error, ours);
    if (ratio.ours) ratio.ratio = best->seconds / ratio.ours->seconds;
  } else if (std::isfinite(spent)) {
    ratio.is_bound = true;
    ratio.ours = fastest(ladders, accuracy, ours);
    if (ratio.ours) ratio.ratio = spent / ratio.ours->seconds;
  }
  return ratio;
}

}  // namespace

const Measured* fastest(const std::vector<PeerLadder>& ladders, double error,
                        const std::function<bool(const PeerLadder&)>& counts) {
  const Measured* best = nullptr;
  for (const PeerLadder& ladder : ladders) {
    if (!counts(ladder)) continue;
    for (const Measured& point : ladder.points) {
      if (reaches(point, error) && (!best || point.seconds < best->seconds)) best = &point;
    }
  }
  return best;
}

std::vector<Ratio> ratios(const std::vector<PeerLadder>& ladders, bool smallest,
                          const std::vector<double>& accuracies) {
  std::vector<Ratio> all;
  const auto add = [&](const std::string& peer, const std::string& force, const auto& theirs) {
    for (const double accuracy : accuracies) {
      all.push_back(ratio_of(ladders, smallest, accuracy, theirs));
      all.back().peer = peer;
      all.back().force = force;
    }
  };
  for (const PeerLadder& ladder : ladders) {
    if (ladder.is_ours) continue;
    const Measured& any = ladder.points.front();
    add(any.solver, any.force, [&](const PeerLadder& l) { return &l == &ladder; });
  }
  for (const ForceKind kind : {ForceKind::plain, ForceKind::ours}) {
    const std::string force = force_name(kind);
    const auto is_theirs = [&](const PeerLadder& l) {
      return l.is_stock_implicit && l.points.front().force == force;
    };
    if (std::ranges::any_of(ladders, is_theirs)) add("best of KLU", force, is_theirs);
  }
  return all;
}

}  // namespace qddot::bench
