#include "src/scene/reduce/mirror.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>

#include <Eigen/Eigenvalues>

namespace qddot {
namespace {

using Eigen::Vector3d;
using Images = std::vector<int>;

// A plane normal.x = offset.
struct Plane {
  Vector3d normal;
  double offset = 0;

  Vector3d image(const Vector3d& x) const { return x - 2 * (normal.dot(x) - offset) * normal; }
  Vector3d turned(const Vector3d& v) const { return v - 2 * normal.dot(v) * normal; }
};

// Finds nodes by their place, up to a tolerance.
class Places {
 public:
  explicit Places(const std::vector<Vector3d>& x) : x_(x), order_(x.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::ranges::sort(order_, {}, [&](int i) { return key(x[i]); });
  }

  // The first node within `tolerance` of a place that `fits`, or -1.
  template <class Fits>
  int find(const Vector3d& place, double tolerance, const Fits& fits) const {
    // Along a unit vector nodes are as close as they are in space, or closer.
    const double low = key(place) - 2 * tolerance;
    auto at = std::ranges::lower_bound(order_, low, {}, [&](int i) { return key(x_[i]); });
    for (; at != order_.end() && key(x_[*at]) <= low + 4 * tolerance; ++at) {
      if ((x_[*at] - place).norm() <= tolerance && fits(*at)) return *at;
    }
    return -1;
  }

 private:
  // A direction that puts few nodes of a regular grid into the same place.
  static double key(const Vector3d& x) {
    return x.dot(Vector3d(0.52573111211913361, 0.64018438963104533, 0.56025190285797853));
  }

  const std::vector<Vector3d>& x_;
  std::vector<int> order_;
};

// Finds springs by their ends.
class Ends {
 public:
  explicit Ends(const std::vector<Spring>& springs) : springs_(springs), order_(springs.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::ranges::sort(order_, {}, [&](std::size_t e) { return key(e); });
  }

  // The springs between the same two nodes, shortest rest length first; as indices.
  std::span<const std::size_t> between(std::size_t a, std::size_t b) const {
    const auto same = [&](std::size_t e) { return pair(e); };
    const auto range =
        std::ranges::equal_range(order_, std::pair(std::min(a, b), std::max(a, b)), {}, same);
    return {range.begin(), range.end()};
  }

 private:
  std::pair<std::size_t, std::size_t> pair(std::size_t e) const {
    const auto [a, b] = springs_[e].nodes;
    return {std::min(a, b), std::max(a, b)};
  }
  std::tuple<std::pair<std::size_t, std::size_t>, double, double, double> key(std::size_t e) const {
    const SpringLaw& law = springs_[e].law;
    return {pair(e), law.rest_length, law.stiffness, law.quartic};
  }

  const std::vector<Spring>& springs_;
  std::vector<std::size_t> order_;
};

bool nearly(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }

class Search {
 public:
  explicit Search(const Body& body)
      : body_(body),
        tolerance_(rounding * largest_coordinate(body.x)),
        speed_tolerance_(rounding * largest_coordinate(body.v)),
        places_(body.x),
        ends_(body.springs) {}

  // A plane normal to `direction` that mirrors the body, with the images of the nodes.
  std::optional<std::pair<Plane, Images>> mirror(const Vector3d& direction) const {
    Plane plane{direction};
    if (std::abs(direction.dot(body_.gravity)) > rounding * body_.gravity.norm()) return {};
    center(plane);
    // A principal axis is known less well than the nodes: what it maps them to decides it.
    constexpr double coarse = 1e-7;
    const bool is_exact = (plane.normal.array() == 0).count() == 2;
    if (!is_exact) {
      const double extent = largest_coordinate(body_.x);
      const auto roughly = images(plane, std::max(tolerance_, coarse * extent), coarse * extent);
      if (!roughly || !refine(plane, *roughly)) return {};
      center(plane);
      if (std::abs(plane.normal.dot(body_.gravity)) > rounding * body_.gravity.norm()) return {};
    }
    const auto exactly = images(plane, tolerance_, speed_tolerance_);
    if (!exactly || !moves_any(*exactly) || !maps_springs(*exactly)) return {};
    return std::pair(plane, *exactly);
  }

 private:
  // Through the middle of all nodes, which a mirror image shares.
  void center(Plane& plane) const {
    double low = INFINITY, high = -INFINITY;
    for (const Vector3d& x : body_.x) {
      low = std::min(low, plane.normal.dot(x));
      high = std::max(high, plane.normal.dot(x));
    }
    plane.offset = low + (high - low) / 2;
  }

  std::optional<Images> images(const Plane& plane, double tolerance, double speed_tolerance) const {
    Images all(body_.x.size(), -1);
    const int free = static_cast<int>(body_.free);
    for (int i = 0; i < std::ssize(all); ++i) {
      if (all[i] >= 0) continue;
      const Vector3d velocity = plane.turned(body_.v[i]);
      all[i] = places_.find(plane.image(body_.x[i]), tolerance, [&](int j) {
        return (all[j] < 0 || all[j] == i) && (j < free) == (i < free) &&
               nearly(body_.mass[i], body_.mass[j], rounding * body_.mass[i]) &&
               (velocity - body_.v[j]).norm() <= speed_tolerance;
      });
      if (all[i] < 0) return {};
      all[all[i]] = i;
    }
    return all;
  }

  // The direction in which most images differ from their nodes, or false where none does.
  bool refine(Plane& plane, const Images& images) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < images.size(); ++i) {
      const auto j = static_cast<std::size_t>(images[i]);
      if (j > i) {
        const Vector3d difference = body_.x[j] - body_.x[i];
        sum += difference.dot(plane.normal) < 0 ? Vector3d(-difference) : difference;
      }
    }
    if (sum.norm() <= tolerance_) return false;
    plane.normal = sum.normalized();
    return true;
  }

  // Where all nodes lie on the plane, that is for the dimension to say.
  bool moves_any(const Images& images) const {
    for (std::size_t i = 0; i < body_.free; ++i) {
      if (images[i] != static_cast<int>(i)) return true;
    }
    return false;
  }

  bool maps_springs(const Images& images) const {
    for (const Spring& spring : body_.springs) {
      const auto [a, b] = spring.nodes;
      const auto own = ends_.between(a, b);
      const auto other =
          ends_.between(static_cast<std::size_t>(images[a]), static_cast<std::size_t>(images[b]));
      if (own.size() != other.size()) return false;
      for (std::size_t e = 0; e < own.size(); ++e) {
        const Spring &drawn = body_.springs[own[e]], &image = body_.springs[other[e]];
        const SpringLaw &one = drawn.law, &two = image.law;
        if (!nearly(one.rest_length, two.rest_length, tolerance_) ||
            !nearly(one.stiffness, two.stiffness, rounding * one.stiffness) ||
            !nearly(one.quartic, two.quartic, rounding * one.quartic) ||
            drawn.holds != image.holds) {
          return false;
        }
      }
    }
    return true;
  }

  const Body& body_;
  double tolerance_, speed_tolerance_;
  Places places_;
  Ends ends_;
};

// Directions worth trying, in space, within the frame.
std::vector<Vector3d> candidates(const Body& body, const Frame& frame) {
  std::vector<Vector3d> all;
  const auto add = [&](const Vector3d& direction) {
    const bool is_new = std::ranges::none_of(
        all, [&](const Vector3d& old) { return std::abs(old.dot(direction)) > 1 - 1e-10; });
    if (is_new) all.push_back(direction);
  };
  const int dimension = frame.dimension;
  for (int a = 0; a < dimension; ++a) add(frame.axes.col(a));
  for (int a = 0; a < dimension; ++a) {
    for (int b = a + 1; b < dimension; ++b) {
      add((frame.axes.col(a) - frame.axes.col(b)).normalized());
      add((frame.axes.col(a) + frame.axes.col(b)).normalized());
    }
  }
  const auto add_principal_axes = [&](std::size_t first, std::size_t last) {
    if (last - first < 2) return;
    Vector3d mean = Vector3d::Zero();
    for (std::size_t i = first; i < last; ++i) mean += frame.point(body.x[i]);
    mean /= static_cast<double>(last - first);
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (std::size_t i = first; i < last; ++i) {
      const Vector3d y = frame.point(body.x[i]) - mean;
      moments += y * y.transpose();
    }
    // Moments of their own keep the axes that are left out apart from the others; they come last.
    const double apart = 1 + 2 * moments.trace();
    for (int d = dimension; d < 3; ++d) moments(d, d) = apart;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments);
    for (int d = 0; d < dimension; ++d) {
      add((frame.axes * Vector3d(axes.eigenvectors().col(d))).normalized());
    }
  };
  add_principal_axes(0, body.free);
  add_principal_axes(body.free, body.x.size());
  return all;
}

}  // namespace

Mirrors mirrors_of(const Body& body, const Frame& frame) {
  const Search search(body);
  std::vector<Plane> planes;
  Mirrors mirrors{.frame = frame};
  for (const Vector3d& direction : candidates(body, frame)) {
    const bool is_apart = std::ranges::all_of(
        planes, [&](const Plane& plane) { return std::abs(plane.normal.dot(direction)) < 1e-7; });
    if (!is_apart || std::ssize(planes) == frame.dimension) continue;
    const auto found = search.mirror(direction);
    if (!found) continue;
    planes.push_back(found->first);
    mirrors.images.push_back(found->second);
  }
  mirrors.count = static_cast<int>(planes.size());
  if (planes.empty()) return mirrors;

  // The planes' normals first, the rest of the frame's space after them.
  Eigen::Matrix3d axes = frame.axes;
  int column = 0;
  for (const Plane& plane : planes) axes.col(column++) = plane.normal;
  for (int d = 0; d < frame.dimension && column < frame.dimension; ++d) {
    const Vector3d axis = frame.axes.col(d);
    Vector3d rest = axis;
    for (int k = 0; k < column; ++k) rest -= axes.col(k).dot(axis) * axes.col(k);
    if (rest.norm() > 0.5) axes.col(column++) = rest.normalized();
  }
  mirrors.frame.axes = axes;
  // A point on all planes; unchanged along the other axes.
  for (const Plane& plane : planes) {
    mirrors.frame.origin += (plane.offset - plane.normal.dot(mirrors.frame.origin)) * plane.normal;
  }
  return mirrors;
}

}  // namespace qddot
