#include "qddot/scene/reduce/frame.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace qddot::reduce {
namespace {

// The vectors that span what changes in time: displacements, loads and accelerations.
std::vector<Eigen::Vector3d> driven_directions(const DrawnPart& drawn) {
  std::vector<Eigen::Vector3d> all;
  std::vector<bool> is_used(drawn.curves.size(), false);
  for (const int curve : drawn.curve_of) {
    if (curve >= 0) is_used[static_cast<std::size_t>(curve)] = true;
  }
  if (drawn.gravity_curve >= 0) is_used[static_cast<std::size_t>(drawn.gravity_curve)] = true;
  for (std::size_t c = 0; c < is_used.size(); ++c) {
    if (!is_used[c]) continue;
    const std::vector<Eigen::Vector3d> own = drawn.curves[c].directions();
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

// Whether all positions share coordinate d, and velocities, gravity and loads are zero in it.
bool is_shared(const DrawnPart& drawn, int d) {
  const auto rests = [&](const Eigen::Vector3d& v) { return v[d] == 0; };
  return drawn.gravity[d] == 0 && std::ranges::all_of(drawn.v, rests) &&
         std::ranges::all_of(drawn.load, rests) &&
         std::ranges::all_of(driven_directions(drawn), rests) &&
         std::ranges::all_of(drawn.x, [&](const auto& x) { return x[d] == drawn.x.front()[d]; });
}

// Orthonormal directions that span the given vectors within rounding.
class Span {
 public:
  // `noise`: the length below which a vector of this kind is rounding.
  void offer(const Eigen::Vector3d& vector, double noise) {
    const Eigen::Vector3d rest = remainder(vector);
    if (rest.norm() > noise && (noise == 0 || rest.norm() / noise > best_)) {
      best_ = noise == 0 ? std::numeric_limits<double>::infinity() : rest.norm() / noise;
      direction_ = remainder(rest.normalized()).normalized();  // twice is enough (Kahan)
    }
  }
  // Takes the best vector offered since the last call; false if none adds a direction.
  bool take() {
    if (best_ == 0) return false;
    basis_.col(rank_++) = direction_;
    best_ = 0;
    return true;
  }
  int rank() const { return rank_; }
  Eigen::Vector3d remainder(const Eigen::Vector3d& vector) const {
    Eigen::Vector3d rest = vector;
    for (int k = 0; k < rank_; ++k) rest -= basis_.col(k).dot(vector) * basis_.col(k);
    return rest;
  }
  const Eigen::Matrix3d& basis() const { return basis_; }

 private:
  Eigen::Matrix3d basis_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();
  int rank_ = 0;
  double best_ = 0;
};

// The span of the motion. Directions are added in the order of their distance above noise.
Span span_of(const DrawnPart& drawn) {
  const double noise = rounding * largest_coordinate(drawn.x);
  const double speed_noise = rounding * largest_coordinate(drawn.v);
  const double load_noise = rounding * largest_coordinate(drawn.load);
  const std::vector<Eigen::Vector3d> driven = driven_directions(drawn);
  const double driven_noise = rounding * largest_coordinate(driven);
  Span span;
  do {
    for (const auto& x : drawn.x) span.offer(x - drawn.x.front(), noise);
    for (const auto& v : drawn.v) span.offer(v, speed_noise);
    span.offer(drawn.gravity, drawn.gravity_noise);
    for (const auto& load : drawn.load) span.offer(load, load_noise);
    for (const auto& direction : driven) span.offer(direction, driven_noise);
  } while (span.take() && span.rank() < 3);
  return span;
}

}  // namespace

Eigen::Matrix3d complete(Eigen::Matrix3d axes, int count) {
  for (; count < 3; ++count) {
    Eigen::Vector3d longest = Eigen::Vector3d::Zero();
    for (int d = 0; d < 3; ++d) {
      Eigen::Vector3d rest = Eigen::Vector3d::Unit(d);
      for (int k = 0; k < count; ++k) rest -= axes(d, k) * axes.col(k);
      if (rest.norm() > longest.norm()) longest = rest;
    }
    axes.col(count) = longest.normalized();
  }
  return axes;
}

Frame frame_of(const DrawnPart& drawn, int dimension) {
  Frame frame{.dimension = 0};
  std::array<bool, 3> is_kept{};
  for (int d = 0; d < dimension; ++d) is_kept[d] = !is_shared(drawn, d);
  // If nothing moves, one coordinate is kept for the system.
  if (std::ranges::count(is_kept, true) == 0) is_kept[0] = true;
  int dropped = 3;
  for (int d = 2; d >= 0; --d) {
    if (!is_kept[d]) frame.axes.col(--dropped) = Eigen::Vector3d::Unit(d);
  }
  for (int d = 0; d < 3; ++d) {
    if (is_kept[d]) {
      frame.axes.col(frame.dimension++) = Eigen::Vector3d::Unit(d);
    } else {
      frame.origin[d] = drawn.x.front()[d];
    }
  }

  // The largest length that does not overflow when squared.
  constexpr double largest = 1e150;
  for (const double size :
       {largest_coordinate(drawn.x), largest_coordinate(drawn.v), largest_coordinate(drawn.load),
        largest_coordinate(driven_directions(drawn)), drawn.gravity.lpNorm<Eigen::Infinity>()}) {
    if (size > largest) return frame;
  }
  const Span span = span_of(drawn);
  if (span.rank() == 0 || span.rank() >= frame.dimension) return frame;
  for (int d = 0; d < 3; ++d) {
    // The coordinate is shared up to a small deviation.
    if (is_kept[d] && span.remainder(Eigen::Vector3d::Unit(d)).norm() > 1 - 1e-9) return frame;
  }
  Frame rotated{span.rank(), drawn.x.front(), complete(span.basis(), span.rank())};
  return rotated;
}

}  // namespace qddot::reduce
