#include "qddot/scene/reduce/mirror.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/scene/reduce/orbits.hpp"
#include "qddot/scene/reduce/part_neighbours.hpp"
#include "qddot/scene/reduce/places.hpp"

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

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool nearly(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }

// How far places [m], velocities [m/s] and loads [N] may be from the mirrored ones, and curves of
// time for their size.
struct Closeness {
  double place, speed, load;
  double mass = rounding;   // relative
  double curve = rounding;  // likewise
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
        ends_(drawn) {
    if (!places_.any_shared(tolerance_)) return;
    neighbours_.emplace(drawn);
    order_ = neighbours_->along_springs();
  }

  // Whether a spring with a rest length is so short that rounding could put both ends into one
  // place, where its direction is undefined.
  bool has_unclear_spring() const {
    constexpr double clear = 1024;  // a direction accurate to a thousandth
    const double least = clear * tolerance_, surely = 2 * least * least;
    for (int e = 0; e < drawn_.springs.size(); ++e) {
      const auto [a, b] = drawn_.springs.ends(e);
      const double square = (drawn_.x[at(b)] - drawn_.x[at(a)]).squaredNorm();
      if (!(square > surely) && drawn_.springs.law(e).rest_length > 0 &&
          !(std::sqrt(square) > least))
        return true;
    }
    return false;
  }

  // A plane normal to `direction` that mirrors the part, with the images of the nodes; these
  // commute with those under `earlier` planes at right angles to it.
  std::optional<std::pair<Plane, Images>> mirror(const Vector3d& direction,
                                                 const std::vector<Images>& earlier) const {
    Plane plane{direction};
    if (std::abs(direction.dot(drawn_.gravity)) > drawn_.gravity_noise) return {};
    if (!are_curves_alike(plane, drawn_.curve_of_gravity(), drawn_.curve_of_gravity(), coarse))
      return {};
    center(plane);
    // A principal axis is less accurate than the nodes: to the square root of rounding if two
    // moments are nearly equal. The pairs of nodes that it finds determine it anew.
    const bool is_exact = (plane.normal.array() == 0).count() == 2;
    if (!is_exact) {
      const double extent = largest_coordinate(drawn_.x);
      const Closeness near{std::max(tolerance_, coarse * extent), coarse * extent,
                           coarse * largest_coordinate(drawn_.load), rounding, coarse};
      if (!may_mirror(plane, near)) return {};
      const auto roughly = images(plane, near, {}, {});
      if (!roughly || !refine(plane, *roughly)) return {};
      center(plane);
      if (std::abs(plane.normal.dot(drawn_.gravity)) > drawn_.gravity_noise) return {};
    }
    if (!are_curves_alike(plane, drawn_.curve_of_gravity(), drawn_.curve_of_gravity(), rounding))
      return {};
    if (!may_mirror(plane, exact_)) return {};
    // The image of the first node decides the images of its neighbours. If several nodes are in one
    // place, each of them is tried.
    for (const int first : candidates(plane, first_node())) {
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

  // Whether a sample of the nodes have images; if not, the search among all of them would fail. An
  // image found through an orbit may be off by several times `near`, as each reflection adds its
  // own. So the sample is given more room, and fails only if all would.
  bool may_mirror(const Plane& plane, const Closeness& near) const {
    constexpr std::size_t sample = 1000;
    constexpr double wider = 16;
    if (drawn_.x.size() < 2 * sample) return true;
    const Closeness wide{wider * near.place, wider * near.speed, wider * near.load,
                         wider * near.mass, wider * near.curve};
    const std::size_t step = drawn_.x.size() / sample;
    for (std::size_t i = 0; i < drawn_.x.size(); i += step) {
      const int own = static_cast<int>(i);
      const int image = places_.find(plane.image(drawn_.x[i]), wide.place,
                                     [&](int j) { return are_alike(plane, own, j, wide); });
      if (image < 0) return false;
    }
    return true;
  }

  bool are_alike(const Plane& plane, int i, int j, const Closeness& near) const {
    const int free = static_cast<int>(drawn_.free);
    return (j < free) == (i < free) &&
           nearly(drawn_.mass[at(i)], drawn_.mass[at(j)], near.mass * drawn_.mass[at(i)]) &&
           (drawn_.v.empty() ||
            (plane.turned(drawn_.v[at(i)]) - drawn_.v[at(j)]).norm() <= near.speed) &&
           (!drawn_.is_loaded() ||
            (plane.turned(drawn_.load[at(i)]) - drawn_.load[at(j)]).norm() <= near.load) &&
           are_curves_alike(plane, drawn_.curve(at(i)), drawn_.curve(at(j)), near.curve);
  }

  static bool are_curves_alike(const Plane& plane, const TimeCurve* one, const TimeCurve* other,
                               double near) {
    if (!one || !other) return one == other;
    const Eigen::Matrix3d turn =
        Eigen::Matrix3d::Identity() - 2 * plane.normal * plane.normal.transpose();
    return one->turned(turn).is_near(*other, near * largest_coordinate(one->directions()));
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
    for (int place = 0; place < std::ssize(all); ++place) {
      const int i = order_.empty() ? place : order_[at(place)];
      if (all[i] >= 0) continue;
      const int image = places_.find(plane.image(drawn_.x[i]), near.place, [&](int j) {
        return (i != first_node() || !first || j == *first) && all[j] < 0 &&
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

  int first_node() const { return order_.empty() ? 0 : order_.front(); }

  // Whether the springs of i to nodes with known images agree with those of j to these images.
  // Only nodes in one place have a choice.
  bool neighbours_agree(int i, int j, const Images& images) const {
    return !neighbours_ || neighbours_->all_of(i, [&](int next) {
      return images[at(next)] < 0 || are_springs_alike(i, next, j, images[at(next)]);
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
    if (!ends_.any_shared()) return maps_single_springs(images);
    for (int e = 0; e < drawn_.springs.size(); ++e) {
      const auto [a, b] = drawn_.springs.ends(e);
      if (!are_springs_alike(a, b, images[at(a)], images[at(b)])) return false;
    }
    return true;
  }

  // The same if no two springs join the same nodes.
  bool maps_single_springs(const Images& images) const {
    const int springs = drawn_.springs.size();
    std::array<int, 256> image_of;  // of a block of springs
    constexpr int block = image_of.size();
    for (int first = 0; first < springs; first += block) {
      const int end = std::min(first + block, springs);
      for (int e = first; e < end; ++e) {
        const auto [a, b] = drawn_.springs.ends(e);
        const int image = ends_.first_between(images[at(a)], images[at(b)]);
        if (image < 0) return false;
        drawn_.springs.prefetch(image);
        image_of[at(e - first)] = image;
      }
      for (int e = first; e < end; ++e) {
        if (!are_alike(e, image_of[at(e - first)])) return false;
      }
    }
    return true;
  }

  // Compares all springs between a and b with all between c and d.
  bool are_springs_alike(int a, int b, int c, int d) const {
    ends_.between(a, b, own_);
    ends_.between(c, d, other_);
    return std::ranges::equal(own_, other_, [&](int e, int f) { return are_alike(e, f); });
  }

  // Compares a spring with one that may be its image.
  bool are_alike(int e, int f) const {
    const auto drawn = drawn_.springs[e], image = drawn_.springs[f];
    const SpringLaw &one = drawn.law, &two = image.law;
    return nearly(one.rest_length, two.rest_length, tolerance_) &&
           nearly(one.stiffness, two.stiffness, rounding * one.stiffness) &&
           nearly(one.quartic, two.quartic, rounding * one.quartic) &&
           nearly(one.damping, two.damping, rounding * one.damping) && drawn.holds == image.holds &&
           one.rigid == two.rigid;
  }

  static constexpr double coarse = 1e-7;

  const DrawnPart& drawn_;
  double tolerance_;  // of places and rest lengths
  Closeness exact_;   // within rounding
  Places places_;
  SpringEnds ends_;
  std::optional<Neighbours> neighbours_;  // if nodes coincide
  std::vector<int> order_;                // in which images are found; empty: that of the nodes
  mutable std::vector<int> own_, other_;  // of are_springs_alike, which is called for all springs
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
