#include "qddot/measure/advice/search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

// Looks at a motion: few if only its end counts, as each costs a step.
constexpr int fewest_looks = 8, most_looks = 24, looks_at_a_path = 400;

int number_of_looks(double steps, AccuracyOf of) {
  if (of != AccuracyOf::positions) return looks_at_a_path;
  constexpr double steps_a_look = 80;
  return static_cast<int>(std::clamp<double>(steps / steps_a_look, fewest_looks, most_looks));
}

}  // namespace

Search::Search(const ReducedScene& model, double until, AccuracyOf of, double seconds,
               const Scene* drawn)
    : limit_(seconds),
      bound_of_w_(frequency_bound(model.system(), model.initial().q)),
      stage_(model, until, of, number_of_looks(until * bound_of_w_ / 2, of), drawn) {}

double Search::steps_of_verlet() const {
  return std::isfinite(bound_of_w_) ? std::max(1.0, stage_.until() * bound_of_w_ / 2) : 1;
}

double Search::seconds_left() const {
  stop_if_interrupted();
  return limit_ - seconds_since(begin_);
}

Trial& Search::run(const Method& method, double value, const Limits& limits, bool is_pushed) {
  const Limits both{std::min(limits.seconds, seconds_left()), limits.forces};
  trials_.push_back(is_pushed ? stage_.run_pushed(method, value, both)
                              : stage_.run(method, value, both));
  Trial& trial = trials_.back();
  if (!is_pushed) stage_.time_again(trial);
  if (forecast_ && !trial.reached_end()) forecast_->learn_failure(trial);
  return trial;
}

void Search::measure_by(const Trial& trial) {
  stage_.measure_by(trial);
  distances_.clear();
  rests_ = stage_.rests();
}

double Search::distance(const Trial& one, const Trial& other) const {
  const auto [place, is_new] =
      distances_.try_emplace(std::minmax(&one, &other, std::less<const Trial*>()));
  if (is_new) place->second = stage_.distance(one, other);
  return place->second;
}

// The largest distance in the second half. Two runs may meet at the end by chance.
double Search::distance_on_the_way(const Trial& one, const Trial& other) const {
  const std::vector<double> all = stage_.distances(one, other);
  const auto half =
      static_cast<std::ptrdiff_t>(stage_.of() == AccuracyOf::path ? 0 : all.size() / 2);
  return *std::max_element(all.begin() + half, all.end());
}

bool Search::was_tried(const Method& method, double value) const {
  constexpr double same = 0.01;
  return std::ranges::any_of(trials_, [&](const Trial& trial) {
    return trial.method == &method && !trial.is_pushed && std::abs(trial.value / value - 1) < same;
  });
}

std::optional<Bound> Search::bound(const Trial& trial) const {
  if (!trial.reached_end()) return {};
  if (stage_.of() == AccuracyOf::energy) {
    // The largest error between the looks and steps may be larger than at them.
    const double between = trial.method->is(Trait::interpolates) ? 4 : 2;
    if (judges_.empty()) return {};
    return Bound{between * stage_.energy_error(trial) + 4 * machine_epsilon +
                 (conditioning_ ? conditioning_->effect : 0)};
  }
  // A run rounds in each of its steps, not only at its start.
  constexpr double roundings = 4;
  const double rounding =
      4 * machine_epsilon +
      roundings * (conditioning_ ? std::max(conditioning_->effect, conditioning_->leaves_by) : 0);
  std::optional<Bound> least;
  for (const auto& [by, judged] : judges_) {
    const bool is_itself = by == &trial;
    const double error = judged.error + rounding + (is_itself ? 0 : distance(trial, *by));
    if (least && least->error <= error) continue;
    least = Bound{error, is_itself ? judged.by : by, is_itself && judged.by_coarser};
  }
  return least;
}

bool Search::is_known(const Trial& trial, double accuracy) const {
  if (trial.is_pushed) return false;
  const auto most = bound(trial);
  return most && most->error <= accuracy;
}

const Trial* Search::best() const {
  const Trial* least = nullptr;
  double error = std::numeric_limits<double>::infinity();
  for (const Trial& trial : trials_) {
    if (trial.is_pushed) continue;
    const auto own = bound(trial);
    if (!own || own->error >= error) continue;
    error = own->error;
    least = &trial;
  }
  return least;
}

const Trial* Search::fastest(double accuracy) const {
  const Trial* least = nullptr;
  for (const Trial& trial : trials_) {
    if ((!least || trial.seconds < least->seconds) && is_known(trial, accuracy)) least = &trial;
  }
  return least;
}

const Trial* Search::find(double accuracy) {
  const Trial* known = fastest(accuracy);
  if (!known) {
    judge(accuracy);
    known = fastest(accuracy);
    // No claim without a look at what rounding does.
    if (known && !conditioning_ && stage_.of() != AccuracyOf::energy) {
      condition(*known);
      known = conditioning_ ? fastest(accuracy) : nullptr;
    }
  }
  return known ? race(known, accuracy) : nullptr;
}

void Search::try_once(const Method& method, double value, double seconds) {
  if (!was_tried(method, value)) run(method, value, {.seconds = seconds});
}

}  // namespace qddot::inline measure
