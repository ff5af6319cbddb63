#include "experiments/crossover/pruning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/measure/speed/front.hpp"

namespace qddot::crossover {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// Calls each(point, its judgement) for the points that have a time.
template <class Each>
void for_timed(const std::vector<Point>& points, const Reference& reference, const Each& each) {
  const auto judged = judged_together(points, reference, Quantity::position);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].outcome == Outcome::reached_end) each(points[i], judged[i]);
  }
}

}  // namespace

Pruning::Pruning(const Reference& reference)
    : reference_(reference),
      count_(static_cast<std::size_t>(std::ranges::count_if(
          accuracies, [&](double a) { return reference.certified.position <= a; }))) {
  fastest_.fill(never);
}

void Pruning::take(const std::vector<Point>& points) {
  for_timed(points, reference_, [&](const Point& point, const Judged& judged) {
    for (std::size_t i = 0; i < count_; ++i) {
      if (judged.is_within(accuracies[i])) fastest_[i] = std::min(fastest_[i], point.time);
    }
  });
}

bool Pruning::is_over(const Point& point) const {
  // Errors beyond the motion itself, as of steps above a stability limit, tell nothing of finer
  // ones.
  if (!(point.errors.position < 1)) return false;
  for (std::size_t i = 0; i < count_; ++i) {
    if (point.errors.position <= accuracies[i]) continue;
    const double slower =
        std::pow(point.errors.position / accuracies[i], 1.0 / std::max(point.method->order, 1));
    if (!(point.time * slower > too_slow * fastest_[i])) return false;
  }
  return true;
}

double Pruning::seconds_of_interest() const {
  return count_ == 0 ? never : too_slow * fastest_[count_ - 1];
}

double Pruning::handicap(const std::vector<Point>& points) const {
  double least = never;
  for_timed(points, reference_, [&](const Point& point, const Judged& judged) {
    for (std::size_t i = 0; i < count_; ++i) {
      if (judged.is_within(accuracies[i])) least = std::min(least, point.time / fastest_[i]);
    }
  });
  return least;
}

std::vector<Placing> placings(const std::vector<Point>& points, const Reference& reference) {
  std::vector<Placing> all;
  for (const double accuracy : Pruning::accuracies) {
    Placing placing{.accuracy = accuracy};
    std::vector<const Point*> counted;
    if (reference.certified.position <= accuracy) {
      for_timed(points, reference, [&](const Point& point, const Judged& judged) {
        if (judged.is_within(accuracy)) counted.push_back(&point);
      });
    }
    for (const Point* point : counted) {
      keep_faster(placing.fastest, *point);
      keep_faster(placing.of_kind[static_cast<std::size_t>(kind_of(*point->method))], *point);
    }
    for (const Point* point : counted) {
      if (point->method != placing.fastest->method) keep_faster(placing.runner_up, *point);
    }
    all.push_back(placing);
  }
  return all;
}

}  // namespace qddot::crossover
