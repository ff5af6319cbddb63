#include "qddot/scene/reduce/mirror.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>

#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/scene/reduce/orbits.hpp"

namespace qddot::reduce {
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
    std::ranges::stable_sort(order_, {}, [&](int i) { return key(x[i]); });
  }

  // Whether some place holds two nodes.
  bool any_shared(double tolerance) const {
    for (int i = 0; i < std::ssize(x_); ++i) {
      if (find(x_[i], tolerance, [&](int j) { return j != i; }) >= 0) return true;
    }
    return false;
  }

  // The first node within `tolerance` of a place that `fits`, or -1.
  template <class Fits>
  int find(const Vector3d& place, double tolerance, const Fits& fits) const {
    // Nodes are no farther apart along a unit vector than in space.
    const double low = key(place) - 2 * tolerance;
    auto at = std::ranges::lower_bound(order_, low, {}, [&](int i) { return key(x_[i]); });
    for (; at != order_.end() && key(x_[*at]) <= low + 4 * tolerance; ++at) {
      if ((x_[*at] - place).norm() <= tolerance && fits(*at)) return *at;
    }
    return -1;
  }

 private:
  // A direction along which the nodes of a regular grid have different places.
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
  std::span<const std::size_t> between(int a, int b) const {
    const auto same = [&](std::size_t e) { return pair(e); };
    const std::pair<std::size_t, std::size_t> ends = std::minmax(a, b);
    return {std::ranges::lower_bound(order_, ends, {}, same),
            std::ranges::upper_bound(order_, ends, {}, same)};
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

// The nodes in an order in which each follows one of its neighbours, if possible.
std::vector<int> along_springs(const DrawnPart& drawn,
                               const std::vector<std::vector<int>>& neighbours) {
  std::vector<int> order;
  std::vector<bool> is_seen(drawn.x.size(), false);
  for (int first = 0; first < std::ssize(drawn.x); ++first) {
    if (is_seen[first]) continue;
    is_seen[first] = true;
    order.push_back(first);
    for (std::size_t at = order.size() - 1; at < order.size(); ++at) {
      for (const int next : neighbours[order[at]]) {
        if (!is_seen[next]) order.push_back(next);
        is_seen[next] = true;
      }
    }
  }
  return order;
}

// How far places [m], velocities [m/s] and loads [N] may be from the mirrored ones.
struct Closeness {
  double place, speed, load;
};

// Finds mirror planes of a part.
class MirrorSearch {
 public:
  explicit MirrorSearch(const DrawnPart& drawn)
      : drawn_(drawn),
        tolerance_(rounding * largest_coordinate(drawn.x)),
        exact_{tolerance_, rounding * largest_coordinate(drawn.v),
               rounding * largest_coordinate(drawn.load)},
        places_(drawn.x),
        ends_(drawn.springs),
        neighbours_(drawn.x.size()),
        order_(drawn.x.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    if (!places_.any_shared(tolerance_)) return;
    for (const Spring& spring : drawn.springs) {
      const auto [a, b] = spring.nodes;
      neighbours_[a].push_back(static_cast<int>(b));
      neighbours_[b].push_back(static_cast<int>(a));
    }
    order_ = along_springs(drawn, neighbours_);
  }

  // Whether a spring with a rest length is so short that rounding could put both ends into one
  // place, where its direction is undefined.
  bool has_unclear_spring() const {
    constexpr double clear = 1024;  // a direction accurate to a thousandth
    return std::ranges::any_of(drawn_.springs, [&](const Spring& spring) {
      const auto [a, b] = spring.nodes;
      return spring.law.rest_length > 0 &&
             !((drawn_.x[b] - drawn_.x[a]).norm() > clear * tolerance_);
    });
  }

  // A plane normal to `direction` that mirrors the part, with the images of the nodes; these
  // commute with those under `earlier` planes at right angles to it.
  std::optional<std::pair<Plane, Images>> mirror(const Vector3d& direction,
                                                 const std::vector<Images>& earlier) const {
    Plane plane{direction};
    if (std::abs(direction.dot(drawn_.gravity)) > drawn_.gravity_noise) return {};
    center(plane);
    // A principal axis is less accurate than the nodes: to the square root of rounding if two
    // moments are nearly equal. The pairs of nodes that it finds determine it anew.
    constexpr double coarse = 1e-7;
    const bool is_exact = (plane.normal.array() == 0).count() == 2;
    if (!is_exact) {
      const double extent = largest_coordinate(drawn_.x);
      const auto roughly = images(plane,
                                  {std::max(tolerance_, coarse * extent), coarse * extent,
                                   coarse * largest_coordinate(drawn_.load)},
                                  {}, {});
      if (!roughly || !refine(plane, *roughly)) return {};
      center(plane);
      if (std::abs(plane.normal.dot(drawn_.gravity)) > drawn_.gravity_noise) return {};
    }
    // The image of the first node decides the images of its neighbours. If several nodes are in one
    // place, each of them is tried.
    for (const int first : candidates(plane, order_.front())) {
      const auto exactly = images(plane, exact_, earlier, first);
      if (exactly && moves_any(*exactly) && maps_springs(*exactly)) {
        return std::pair(plane, *exactly);
      }
    }
    return {};
  }

 private:
  // Puts the plane through the middle of all nodes, which any mirror plane contains.
  void center(Plane& plane) const {
    double low = INFINITY, high = -INFINITY;
    for (const Vector3d& x : drawn_.x) {
      low = std::min(low, plane.normal.dot(x));
      high = std::max(high, plane.normal.dot(x));
    }
    plane.offset = low + (high - low) / 2;
  }

  bool are_alike(const Plane& plane, int i, int j, const Closeness& near) const {
    const int free = static_cast<int>(drawn_.free);
    return (j < free) == (i < free) &&
           nearly(drawn_.mass[i], drawn_.mass[j], rounding * drawn_.mass[i]) &&
           (plane.turned(drawn_.v[i]) - drawn_.v[j]).norm() <= near.speed &&
           (plane.turned(drawn_.load[i]) - drawn_.load[j]).norm() <= near.load;
  }

  std::vector<int> candidates(const Plane& plane, int i) const {
    std::vector<int> all;
    places_.find(plane.image(drawn_.x[i]), tolerance_, [&](int j) {
      if (are_alike(plane, i, j, exact_)) all.push_back(j);
      return false;
    });
    return all;
  }

  // The reflection S must commute with the group G of the earlier ones: if i has the image j, then
  // g i has g j for all g in G. This requires that the same g leave i and j in place.
  std::optional<Images> images(const Plane& plane, const Closeness& near,
                               const std::vector<Images>& earlier, std::optional<int> first) const {
    Images all(drawn_.x.size(), -1);
    const Orbits orbits(earlier);
    for (const int i : order_) {
      if (all[i] >= 0) continue;
      const int image = places_.find(plane.image(drawn_.x[i]), near.place, [&](int j) {
        return (i != order_.front() || !first || j == *first) && all[j] < 0 &&
               are_alike(plane, i, j, near) && orbits.are_fixed_alike(i, j) &&
               neighbours_agree(i, j, all);
      });
      if (image < 0) return {};
      for (unsigned g = 0; g < orbits.elements(); ++g) {
        const int a = orbits.image(g, i), b = orbits.image(g, image);
        all[a] = b;
        all[b] = a;
      }
    }
    return all;
  }

  // Whether the springs of i to nodes with known images agree with those of j to these images.
  bool neighbours_agree(int i, int j, const Images& images) const {
    return std::ranges::all_of(neighbours_[i], [&](int next) {
      return images[next] < 0 || are_springs_alike(i, next, j, images[next]);
    });
  }

  // Turns the plane's normal to the mean direction from nodes to their images; false if no node
  // moves.
  bool refine(Plane& plane, const Images& images) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < images.size(); ++i) {
      const auto j = static_cast<std::size_t>(images[i]);
      if (j > i) {
        const Vector3d difference = drawn_.x[j] - drawn_.x[i];
        sum += difference.dot(plane.normal) < 0 ? Vector3d(-difference) : difference;
      }
    }
    if (sum.norm() <= tolerance_) return false;
    plane.normal = sum.normalized();
    return true;
  }

  // Whether any free node has another image than itself. Else all lie on the plane, and the
  // dimension is reduced instead.
  bool moves_any(const Images& images) const {
    for (std::size_t i = 0; i < drawn_.free; ++i) {
      if (images[i] != static_cast<int>(i)) return true;
    }
    return false;
  }

  bool maps_springs(const Images& images) const {
    return std::ranges::all_of(drawn_.springs, [&](const Spring& spring) {
      const auto [a, b] = spring.nodes;
      return are_springs_alike(static_cast<int>(a), static_cast<int>(b), images[a], images[b]);
    });
  }

  // Compares all springs between a and b with all between c and d.
  bool are_springs_alike(int a, int b, int c, int d) const {
    const auto own = ends_.between(a, b), other = ends_.between(c, d);
    return std::ranges::equal(own, other, [&](std::size_t e, std::size_t f) {
      const Spring &drawn = drawn_.springs[e], &image = drawn_.springs[f];
      const SpringLaw &one = drawn.law, &two = image.law;
      return nearly(one.rest_length, two.rest_length, tolerance_) &&
             nearly(one.stiffness, two.stiffness, rounding * one.stiffness) &&
             nearly(one.quartic, two.quartic, rounding * one.quartic) && drawn.holds == image.holds;
    });
  }

  const DrawnPart& drawn_;
  double tolerance_;  // of places and rest lengths
  Closeness exact_;   // within rounding
  Places places_;
  Ends ends_;
  std::vector<std::vector<int>> neighbours_;  // of each node; empty where no two nodes coincide
  std::vector<int> order_;                    // in which images are found
};

// The directions in the frame that are tried as normals.
std::vector<Vector3d> candidates(const DrawnPart& drawn, const Frame& frame) {
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
    for (std::size_t i = first; i < last; ++i) mean += frame.point(drawn.x[i]);
    mean /= static_cast<double>(last - first);
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (std::size_t i = first; i < last; ++i) {
      const Vector3d y = frame.point(drawn.x[i]) - mean;
      moments += y * y.transpose();
    }
    // Large moments separate the axes outside of the frame; they come last.
    const double apart = 1 + 2 * moments.trace();
    for (int d = dimension; d < 3; ++d) moments(d, d) = apart;
    const EigenPairs axes = dense_pairs(moments);
    for (int d = 0; d < dimension; ++d) {
      add((frame.axes * Vector3d(axes.vectors.col(d))).normalized());
    }
  };
  add_principal_axes(0, drawn.free);
  add_principal_axes(drawn.free, drawn.x.size());
  return all;
}

}  // namespace

Mirrors mirrors_of(const DrawnPart& drawn, const Frame& frame) {
  const MirrorSearch search(drawn);
  std::vector<Plane> planes;
  Mirrors mirrors{.frame = frame};
  if (search.has_unclear_spring()) return mirrors;
  for (const Vector3d& direction : candidates(drawn, frame)) {
    const bool is_apart = std::ranges::all_of(
        planes, [&](const Plane& plane) { return std::abs(plane.normal.dot(direction)) < 1e-7; });
    if (!is_apart || std::ssize(planes) == frame.dimension) continue;
    const auto found = search.mirror(direction, mirrors.images);
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
  // A point on all planes; its coordinates along the other axes stay.
  for (const Plane& plane : planes) {
    mirrors.frame.origin += (plane.offset - plane.normal.dot(mirrors.frame.origin)) * plane.normal;
  }
  return mirrors;
}

}  // namespace qddot::reduce
