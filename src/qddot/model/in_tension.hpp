#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "qddot/model/layout.hpp"
#include "qddot/model/spring.hpp"
#include "qddot/model/squared_length.hpp"

namespace qddot {

// The part of a rest length by which rounding may make a spring shorter that is drawn at it.
constexpr double forgiven = 1e-12;

// The motion of a spring's length l at some time.
struct LengthMotion {
  double length = 0, rate = 0, acceleration = 0;  // l [m], l' [m/s], l'' [m/s^2]
  double turning = 0;                             // the part of l'' by which the spring turns
};

// The length of a spring in a step that does not resolve its vibration w [rad/s]. It vibrates about
// the place at which the forces of the start hold it, l + l''/w^2. In the first turn this place may
// stay; else it moves straight to that of the end, which may be anywhere if it is not resolved. So
// this is the motion of the system from the start on, not as the method computes it.
//
// Methods of order one have velocities of the size h turning/2 along a spring that only turns. A
// rate that is common to both ends, and that the lengths do not show, is not counted up to twice
// that, and up to half of the speed across.
class Swing {
 public:
  Swing(const LengthMotion& from, const LengthMotion& to, double w, double h);
  // The part of the step after which it is first shorter than `bound` [m]; nothing if it never is.
  std::optional<double> first_slack(double bound) const;
  double last() const { return last_; }  // the length at the end [m]

 private:
  std::optional<double> first_slack(double bound, double slope, double longest_turn) const;

  double turn_;                           // h w
  double first_, last_, middle_, slope_;  // `slope_`: the change of the middle in the step
  double cosine_, rate_;                  // l - middle, and l'/w, at the start
};

// Positions of nodes, and how far the points on curves are displaced; and a motion from there.
template <int D>
struct Placed {
  using Point = Eigen::Matrix<double, D, 1>;

  const Layout<D>& layout;
  VecView q;
  std::vector<Point> curves;

  Point of(int curve) const { return curve < 0 ? Point(Point::Zero()) : curves[curve]; }
};
template <int D>
struct PlacedMotion {
  Placed<D> place;
  std::vector<typename Placed<D>::Point> curve_rates;
  VecView v;
};

// The springs of a network that hold in tension only (Holds::in_tension), and series of springs
// that are one such spring (MasslessSeries).
template <int D>
class InTension {
 public:
  using Point = Eigen::Matrix<double, D, 1>;
  // d = diag(place) x_j - x_i, or place - x_i where j < 0: place is a mirror or a fixed point [m].
  struct Spring {
    int i, j;
    Point place;
    SpringLaw law;
    bool is_series = false;  // of springs that stand on their own; see MasslessSeries
    int curve = -1;          // of a fixed point that moves, see Network::Anchor
  };

  void add(const Spring& spring) { springs_.push_back(spring); }
  bool empty() const { return springs_.empty(); }

  // Whether no spring is shorter than its rest length.
  bool holds_at(const Placed<D>& now) const {
    return std::ranges::all_of(springs_, [&](const Spring& spring) {
      return difference(spring, now).squaredNorm() >= bound(spring);
    });
  }

  // The first time [s] between t_from and t_to at which a spring gets shorter than its rest length;
  // nothing if none does. In a step that resolves the spring's vibration, h w <= 2, each d follows
  // the cubic that has its values and rates at both ends. For longer steps see Swing; these need
  // the system's force(is_end, f).
  template <class Force>
  std::optional<double> first_slack(const Vec& mass, double t_from, const PlacedMotion<D>& from,
                                    double t_to, const PlacedMotion<D>& to,
                                    const Force& force) const {
    const double h = t_to - t_from;
    const Layout<D>& layout = from.place.layout;
    Vec pull_from, pull_to;
    std::optional<double> first;
    for (const Spring& spring : springs_) {
      const double w = frequency(layout, mass, spring);
      std::optional<double> s;
      double last;  // the length at the end, squared
      if (h * w > longest_resolved && std::isfinite(w)) {
        if (pull_from.size() == 0) {
          force(false, pull_from);
          force(true, pull_to);
        }
        const Swing swing(motion(mass, spring, from, pull_from), motion(mass, spring, to, pull_to),
                          w, h);
        s = swing.first_slack((1 - forgiven) * spring.law.rest_length);
        last = swing.last() * swing.last();
      } else {
        const SquaredLength length = path(spring, from, to, h, std::isfinite(w));
        s = first_below(length, bound(spring));
        last = length.back();
      }
      // If the spring was too short at the start already, only its end counts. A series that is not
      // straight is no such spring.
      if (s == 0 && (last >= bound(spring) || spring.is_series)) s.reset();
      if (s && (!first || *s < *first)) first = s;
    }
    if (!first) return {};
    return t_from + *first * h;
  }

 private:
  // h w up to which the rates at both ends show the motion between.
  static constexpr double longest_resolved = 2;

  static double bound(const Spring& spring) {
    const double l = (1 - forgiven) * spring.law.rest_length;
    return l * l;
  }
  static Point difference(const Spring& spring, const Placed<D>& now) {
    const Point own = now.layout.at(now.q, spring.i);
    if (spring.j < 0) return spring.place + now.of(spring.curve) - own;
    return spring.place.cwiseProduct(now.layout.at(now.q, spring.j)) - own;
  }
  static Point rate(const Spring& spring, const PlacedMotion<D>& now) {
    const Point apart = rate(now.place.layout, spring, now.v);
    return spring.curve < 0 ? apart : Point(apart + now.curve_rates[spring.curve]);
  }
  // The same of a point that rests.
  static Point rate(const Layout<D>& layout, const Spring& spring, const VecView& v) {
    const Point own = layout.at(v, spring.i);
    return spring.j < 0 ? Point(-own) : spring.place.cwiseProduct(layout.at(v, spring.j)) - own;
  }

  // The frequency [rad/s] of the spring alone; infinite at a massless node.
  static double frequency(const Layout<D>& layout, const Vec& mass, const Spring& spring) {
    return std::sqrt(spring.law.stiffness *
                     (per_mass(layout, mass, spring.i) + per_mass(layout, mass, spring.j)));
  }

  // The length's motion at one end of a step, by the system's forces there; its point, if it has
  // one, does not accelerate.
  static LengthMotion motion(const Vec& mass, const Spring& spring, const PlacedMotion<D>& now,
                             const Vec& pull) {
    const Point d = difference(spring, now.place), v = rate(spring, now);
    Vec a = pull;
    for (Index i = 0; i < a.size(); ++i) a[i] = mass[i] > 0 ? a[i] / mass[i] : 0;
    const double l = d.norm();
    if (!(l > 0)) return {};
    const double along = v.dot(d) / l, turning = (v.squaredNorm() - along * along) / l;
    const double pull_along = rate(now.place.layout, spring, a).dot(d) / l;
    return {l, along, pull_along + turning, turning};
  }

  // The squared length on the cubic; on a straight line if the rates say nothing, as at a massless
  // node.
  static SquaredLength path(const Spring& spring, const PlacedMotion<D>& from,
                            const PlacedMotion<D>& to, double h, bool uses_rates) {
    const Point a = difference(spring, from.place), d = difference(spring, to.place);
    const double third = h / 3;
    Point b = a + (d - a) / 3, c = d - (d - a) / 3;
    if (uses_rates) {
      b = a + third * rate(spring, from);
      c = d - third * rate(spring, to);
    }
    return squared_length<D>(a, b, c, d);
  }
  static double per_mass(const Layout<D>& layout, const Vec& mass, int node) {
    return node < 0 || layout.count(node) == 0 ? 0 : 1 / mass[layout.first(node)];
  }

  std::vector<Spring> springs_;
};

}  // namespace qddot
