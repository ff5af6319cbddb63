#pragma once

#include <array>
#include <vector>

#include "qddot/measure/speed/measurement.hpp"

namespace qddot::crossover {

enum class Kind { explicit_steps, implicit_steps, split, rods };
constexpr std::array kinds = {Kind::explicit_steps, Kind::implicit_steps, Kind::split, Kind::rods};

// As it is written to tables.
constexpr const char* kind_name(Kind kind) {
  constexpr std::array names = {"explicit", "implicit", "split", "rods"};
  return names[static_cast<std::size_t>(kind)];
}

// Methods that separate stiff and soft forces are split, whichever of them they integrate
// implicitly. Those that keep constraints run the scene with rods in place of its stiff springs.
inline Kind kind_of(const Method& method) {
  if (method.asks(Need::constraints)) return Kind::rods;
  if (method.asks(Need::split_forces)) return Kind::split;
  return method.is(Trait::implicit) ? Kind::implicit_steps : Kind::explicit_steps;
}

// The fastest at one accuracy: of all methods, of all others than that one, and of each kind.
// nullptr where there is none.
struct Placing {
  double accuracy = 0;
  const Point* fastest = nullptr;
  const Point* runner_up = nullptr;
  std::array<const Point*, kinds.size()> of_kind{};
};

// Tells which runs need not be made where methods compete on one scene for the accuracies 1e-1,
// 1e-2, ... 1e-6, as far as the reference is certain. Methods take their points from coarse to
// fine. A point has reached an accuracy if it counts as within it (see judged_together). Borrows
// the reference.
class Pruning {
 public:
  static constexpr std::array accuracies = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
  // Slower by this factor, a method does not count.
  static constexpr double too_slow = 20;

  explicit Pruning(const Reference& reference);

  // Takes the points of a method.
  void take(const std::vector<Point>& points);
  // Whether finer points of the method than this one are of no interest. It has then reached the
  // finest accuracy, or would be too slow at each remaining one. Its time is taken to grow by its
  // order, time ~ error^(-1/order).
  bool is_over(const Point& point) const;
  // Time [s] after which a run is too slow even at the finest accuracy; infinite if no method
  // reached that accuracy.
  double seconds_of_interest() const;
  // The least factor, over all accuracies, by which the method is slower than the fastest one.
  // Infinite if it reached no accuracy. `points`: of that method.
  double handicap(const std::vector<Point>& points) const;

 private:
  const Reference& reference_;
  std::size_t count_;  // how many of the accuracies are certain
  std::array<double, accuracies.size()> fastest_;
};

// The placings at each of the accuracies, pointers into `points`; nullptr where the reference is
// not that certain.
std::vector<Placing> placings(const std::vector<Point>& points, const Reference& reference);

}  // namespace qddot::crossover
