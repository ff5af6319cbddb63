#include "qddot/measure/speed/ladder_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "qddot/measure/motion/vibrating_modes.hpp"
#include "qddot/measure/speed/judgement.hpp"
#include "qddot/measure/speed/ladder.hpp"

namespace qddot::inline measure {
namespace {

// The most points on either side of number 0; errors reach rounding long before.
constexpr int most_points = 60;

// Values of the knob, finer with the number. Number 0 of a step size is h w = 4 for explicit
// methods, beyond the stability limit of most, and half the run for implicit ones.
class KnobValues {
 public:
  KnobValues(const Method& method, const Model& scene, double until)
      : method_(method), until_(until) {
    const double w = resolved_frequency(method, scene.system(), scene.initial().q);
    steps_ = method.is(Trait::implicit) ? 2 : std::max(1.0, std::ceil(until * w / 4));
  }

  // The value with this number; empty if it does not exist.
  std::optional<double> value(int number) const {
    if (std::abs(number) > most_points) return {};
    // A method without error of its steps needs one step only.
    if (method_.order == 0) return number == 0 ? std::optional(until_) : std::nullopt;
    if (method_.knob == Knob::rtol) {
      const double rtol = std::pow(10.0, -1 - number);
      return rtol <= 0.1 && rtol >= 1e-15 ? std::optional(rtol) : std::nullopt;
    }
    const double steps =
        std::round(steps_ * std::pow(4.0, static_cast<double>(number) / method_.order));
    return steps >= 1 ? std::optional(until_ / steps) : std::nullopt;
  }

 private:
  const Method& method_;
  double until_, steps_;
};

// The judged error of a run; infinite if it is another motion than the reference's.
double error_of(const Point& point, const Reference& reference) {
  const Judged error = judged(point, reference);
  return error.may_count ? error.error : std::numeric_limits<double>::infinity();
}

// Detects that a finer knob no longer reduces the error.
class Stagnation {
 public:
  explicit Stagnation(const Reference& reference) : reference_(reference) {}

  bool after(const Point& point) {
    if (point.outcome != Outcome::reached_end) return false;
    // Steps that are limited by stability do not follow the tolerance yet.
    if (2 * point.counts.stability_limited_steps > point.counts.steps) return false;
    const double error = error_of(point, reference_);
    idle_ = error > 0.8 * best_ ? idle_ + 1 : 0;
    best_ = std::min(best_, error);
    return idle_ >= 3 && best_ < 1e-4;
  }

 private:
  const Reference& reference_;
  double best_ = std::numeric_limits<double>::infinity();
  int idle_ = 0;
};

// Whether a finer run is sure to exceed the time limit. The time of fixed steps is proportional to
// their number. Shorter implicit steps are cheaper, since Newton then needs fewer iterations.
bool takes_too_long(const Method& method, const Point& last, double value, const Effort& effort) {
  const double saved_at_most = method.is(Trait::implicit) ? 10 : 1;
  return method.knob == Knob::step_size && last.outcome == Outcome::reached_end &&
         last.time * last.value / value > 1.5 * saved_at_most * effort.seconds;
}

bool is_good(const Point& point, const Reference& reference) {
  return point.outcome == Outcome::reached_end && error_of(point, reference) < 1;
}

// Whether coarse steps end at a stability limit: those of explicit methods do, and implicit ones
// whose energy grew without bound. Other implicit ones become inaccurate or find no solution.
bool has_limit(const Method& method, const std::vector<Point>& points) {
  if (method.knob != Knob::step_size || method.order == 0 || linear_limit(method) == 0)
    return false;
  return !method.is(Trait::implicit) ||
         std::ranges::find(points, Outcome::diverged, &Point::outcome) != points.end();
}

// The rungs of a ladder of step sizes that may be refined, from the coarsest to the first that is
// accurate enough or over budget.
std::vector<Rung> rungs(const std::vector<Point>& points, double until, const Reference& reference,
                        const std::function<bool(const Point&)>& is_enough) {
  std::vector<Rung> ladder;
  for (const Point& point : points) {
    if (point.outcome == Outcome::over_budget) break;
    const bool reached = point.outcome == Outcome::reached_end;
    ladder.push_back(
        {std::round(until / point.value),
         reached ? error_of(point, reference) : std::numeric_limits<double>::infinity()});
    if (reached && is_enough(point)) break;
  }
  return ladder;
}

}  // namespace

std::vector<Point> measure_ladder(const Method& method, const Model& scene, double until,
                                  const Reference& reference, const Effort& effort,
                                  const std::function<void(const Point&)>& report,
                                  const std::function<bool(const Point&)>& is_last) {
  const KnobValues values(method, scene, until);
  const auto is_enough = [&](const Point& point) {
    return error_of(point, reference) <= certified(reference) || (is_last && is_last(point));
  };
  std::vector<Point> points;
  // One run may be accurate by luck, two are not.
  const auto ends_well = [&] {
    if (!is_enough(points.back())) return false;
    const bool is_second = points.size() > 1 && points.end()[-2].outcome == Outcome::reached_end &&
                           is_enough(points.end()[-2]);
    return is_second || last_follows_order(points, reference);
  };
  const auto take = [&](double value) -> const Point& {
    points.push_back(!points.empty() && takes_too_long(method, points.back(), value, effort)
                         ? Point{.method = &method, .value = value, .outcome = Outcome::over_budget}
                         : measure_point(method, value, scene, until, reference, effort));
    report(points.back());
    return points.back();
  };

  for (int number = 0; const auto value = values.value(number); --number) {
    if (!points.empty() && points.back().value == *value) continue;
    if (!is_good(take(*value), reference)) break;
  }
  std::ranges::reverse(points);

  Stagnation stagnation(reference);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) stagnation.after(points[i]);
  int unfinished = 0;
  for (int number = 1; const auto value = values.value(number); ++number) {
    const Point& last = points.back();
    if (last.value == *value) continue;
    if (last.outcome == Outcome::reached_end && (ends_well() || stagnation.after(last))) break;
    // A finer implicit run may be faster if Newton's iteration hardly converges at the coarse end:
    // two runs over budget are accepted. Explicit runs only become longer.
    unfinished = last.outcome == Outcome::over_budget ? unfinished + 1 : 0;
    const bool has_worked =
        std::ranges::any_of(points, [&](const Point& p) { return is_good(p, reference); });
    if (last.outcome == Outcome::singular_mass ||
        unfinished > (has_worked || !method.is(Trait::implicit) ? 0 : 2))
      break;
    take(*value);
  }

  if (!has_limit(method, points)) return points;
  while (const auto steps = lacking_rung(rungs(points, until, reference, is_enough))) {
    const Point point = measure_point(method, until / *steps, scene, until, reference, effort);
    report(point);
    const auto finer =
        std::ranges::find_if(points, [&](const Point& other) { return other.value < point.value; });
    points.insert(finer, point);
    if (point.outcome == Outcome::over_budget) break;  // although a finer one was not
  }
  return points;
}

}  // namespace qddot::inline measure
