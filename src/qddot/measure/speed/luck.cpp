// The errors at which runs count: see judged_together().
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "qddot/measure/speed/judgement.hpp"

namespace qddot::inline measure {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// The powers of an expected fall between which errors fall as the order says. Where it does, they
// fall by some percent more or less. Errors of chance seldom do so twice.
constexpr double least_fall = 0.75, largest_fall = 1.25;

// The evidence that a run gives on the coarser ones.
struct Run {
  std::size_t point;
  double value;           // of the knob
  double error, at_most;  // infinite if it is known to be another motion
};

// Empty if it tells nothing.
std::optional<Run> run_of(const Point& point, const Judged& judged, std::size_t number) {
  const bool is_lost = point.outcome == Outcome::diverged || point.outcome == Outcome::not_finite;
  if (is_lost || !judged.may_count) return Run{number, point.value, infinite, infinite};
  if (std::isnan(judged.error)) return {};
  return Run{number, point.value, judged.error, judged.bounds.at_most};
}

double expected_fall(const Method& method, double coarse, double fine) {
  const double ratio = coarse / fine;
  return method.knob == Knob::step_size ? std::pow(ratio, method.order) : ratio;
}

// The runs of one method, from coarse to fine.
class Sequence {
 public:
  Sequence(const Method& method, std::vector<Run> runs) : method_(method), runs_(std::move(runs)) {
    std::ranges::stable_sort(runs_, std::ranges::greater(), &Run::value);
  }

  // Lets each point count at the largest error up to where the order shows.
  void count(std::vector<Judged>& judged) const {
    std::size_t end = runs_.size();  // one past the runs that count for the present one
    for (std::size_t i = runs_.size(); i-- > 0;) {
      if (const auto second = order_shows(i)) end = *second + 1;
      double& counts_at = judged[runs_[i].point].counts_at;
      for (std::size_t j = i; j < end; ++j) counts_at = std::max(counts_at, runs_[j].at_most);
    }
  }

  // Whether the finest run is the second rung of one at which the order shows.
  bool last_follows() const {
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      if (order_shows(i) == runs_.size() - 1) return true;
    }
    return false;
  }

 private:
  // The run of the rung after run i, if errors fall as they should; else empty.
  std::optional<std::size_t> rung(std::size_t i) const {
    for (std::size_t j = i + 1; j < runs_.size(); ++j) {
      const double expected = expected_fall(method_, runs_[i].value, runs_[j].value);
      if (expected < 2) continue;
      const double coarse = runs_[i].error, fine = runs_[j].error;
      const double fall = std::log(coarse / fine) / std::log(expected);
      return fall >= least_fall && fall <= largest_fall ? std::optional(j) : std::nullopt;
    }
    return {};
  }

  // The second rung after run i, if the order shows at i.
  std::optional<std::size_t> order_shows(std::size_t i) const {
    const auto first = rung(i);
    return first ? rung(*first) : std::nullopt;
  }

  const Method& method_;
  std::vector<Run> runs_;
};

}  // namespace

std::vector<Judged> judged_together(const std::vector<Point>& points, const Reference& reference,
                                    Quantity quantity) {
  std::vector<Judged> all;
  std::map<const Method*, std::vector<Run>> runs;
  for (const Point& point : points) {
    all.push_back(judged(point, reference, quantity));
    if (const auto run = run_of(point, all.back(), all.size() - 1))
      runs[point.method].push_back(*run);
  }
  for (auto& [method, own] : runs) Sequence(*method, std::move(own)).count(all);
  for (Judged& one : all) {
    one.is_lucky = std::ranges::any_of(usual_accuracies(), [&](double accuracy) {
      return one.bounds.at_most <= accuracy && one.counts_at > accuracy;
    });
  }
  return all;
}

bool last_follows_order(const std::vector<Point>& points, const Reference& reference) {
  std::vector<Run> runs;
  for (const Point& point : points) {
    if (const auto run = run_of(point, judged(point, reference), runs.size())) runs.push_back(*run);
  }
  return !runs.empty() && Sequence(*points.back().method, std::move(runs)).last_follows();
}

}  // namespace qddot::inline measure
