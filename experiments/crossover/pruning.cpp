#include "experiments/crossover/pruning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/measure/speed/front.hpp"

namespace qddot::crossover {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

bool reaches(const Point& point, double accuracy) {
  return point.outcome == Outcome::reached_end && point.errors.position <= accuracy;
}

}  // namespace

Pruning::Pruning(const Reference& reference)
    : count_(static_cast<std::size_t>(std::ranges::count_if(
          accuracies, [&](double a) { return reference.certified.position <= a; }))) {
  fastest_.fill(never);
}

void Pruning::take(const Point& point) {
  for (std::size_t i = 0; i < count_; ++i) {
    if (reaches(point, accuracies[i])) fastest_[i] = std::min(fastest_[i], point.time);
  }
}

bool Pruning::is_over(const Point& point) const {
  // Errors beyond the motion itself, as of steps above a stability limit, tell nothing of finer
  // ones.
  if (!(point.errors.position < 1)) return false;
  for (std::size_t i = 0; i < count_; ++i) {
    if (reaches(point, accuracies[i])) continue;
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
  for (const Point& point : points) {
    for (std::size_t i = 0; i < count_; ++i) {
      if (reaches(point, accuracies[i])) least = std::min(least, point.time / fastest_[i]);
    }
  }
  return least;
}

std::vector<Placing> placings(const std::vector<Point>& points, const Reference& reference) {
  std::vector<Placing> all;
  for (const double accuracy : Pruning::accuracies) {
    Placing placing{.accuracy = accuracy};
    std::vector<const Point*> counted;
    if (reference.certified.position <= accuracy) {
      for (const Point& point : points) {
        if (reaches(point, accuracy)) counted.push_back(&point);
      }
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
