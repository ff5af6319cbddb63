#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "qddot/model/layout.hpp"
#include "qddot/model/spring.hpp"

namespace qddot {

// The squared length of a spring [m^2] during a step: a polynomial of degree 6 in s = 0 ... 1, by
// its Bernstein coefficients c. If all c are above a bound, so is the polynomial. c_0 and c_6 are
// its values at the ends.
using SquaredLength = std::array<double, 7>;

// The first s in [0, 1] at which the polynomial is below `bound`, to a millionth; nothing if there
// is none.
std::optional<double> first_below(const SquaredLength& c, double bound);

// The springs of a network that hold in tension only (Holds::in_tension).
template <int D>
class InTension {
 public:
  using Point = Eigen::Matrix<double, D, 1>;
  // d = diag(place) x_j - x_i, or place - x_i where j < 0: place is a mirror or a fixed point [m].
  struct Spring {
    int i, j;
    Point place;
    SpringLaw law;
  };

  void add(const Spring& spring) { springs_.push_back(spring); }
  bool empty() const { return springs_.empty(); }

  // Whether no spring is shorter than its rest length at q.
  bool holds_at(const Layout<D>& layout, const ConstVec& q) const {
    return std::ranges::all_of(springs_, [&](const Spring& spring) {
      return difference(layout, spring, q).squaredNorm() >= bound(spring);
    });
  }

  // The first time [s] between two states at which a spring gets shorter than its rest length;
  // nothing if none does. Each d follows the cubic that has its values and rates at both ends.
  std::optional<double> first_slack(const Layout<D>& layout, const Vec& mass, const State& from,
                                    const State& to) const {
    if (springs_.empty()) return {};
    std::optional<double> first;
    for (const Spring& spring : springs_) {
      const SquaredLength length = path(layout, mass, spring, from, to);
      std::optional<double> s = first_below(length, bound(spring));
      // If the spring was too short at the start already, only its end counts.
      if (s == 0 && length.back() >= bound(spring)) s.reset();
      if (s && (!first || *s < *first)) first = s;
    }
    if (!first) return {};
    return from.t + *first * (to.t - from.t);
  }

 private:
  // A spring drawn at its rest length may be shorter by rounding.
  static double bound(const Spring& spring) {
    const double l = (1 - 1e-12) * spring.law.rest_length;
    return l * l;
  }
  static Point difference(const Layout<D>& layout, const Spring& spring, const ConstVec& q) {
    if (spring.j < 0) return spring.place - layout.at(q, spring.i);
    return spring.place.cwiseProduct(layout.at(q, spring.j)) - layout.at(q, spring.i);
  }
  static Point rate(const Layout<D>& layout, const Spring& spring, const Vec& v) {
    if (spring.j < 0) return -layout.at(v, spring.i);
    return difference(layout, spring, v);
  }

  // The cubic resolves a vibration along the spring, w^2 = k (1/m_i + 1/m_j), if h w <= 2. For a
  // longer step, the rates of l at both ends are corrected twice. First they lose their common part
  // that the lengths do not show: it is a first-order error of the velocities. Then they are scaled
  // by 4/(h w): a vibration of speed u has the amplitude u/w, but the cubic reaches u h/4. If h w >
  // 8, the vibration turns more than once in a step, and the ends give no information about it.
  static SquaredLength path(const Layout<D>& layout, const Vec& mass, const Spring& spring,
                            const State& from, const State& to) {
    const double h = to.t - from.t;
    const Point a = difference(layout, spring, from.q), d = difference(layout, spring, to.q);
    Point a_rate = rate(layout, spring, from.v), d_rate = rate(layout, spring, to.v);
    const double hw = h * std::sqrt(spring.law.stiffness * (per_mass(layout, mass, spring.i) +
                                                            per_mass(layout, mass, spring.j)));
    const double first = a.norm(), last = d.norm();
    if (hw > 2 && first > 0 && last > 0) {
      const double r = a_rate.dot(a) / first, s = d_rate.dot(d) / last;
      const double common = (r + s) / 2 - (last - first) / h,
                   share = hw > 8 ? 0 : std::min(1.0, 4 / hw);
      a_rate -= (r - share * (r - common)) / first * a;
      d_rate -= (s - share * (s - common)) / last * d;
    }
    // The cubic's Bernstein coefficients, and their products.
    const Point b = a + h / 3 * a_rate, c = d - h / 3 * d_rate;
    return {a.dot(a),
            a.dot(b),
            (2 * a.dot(c) + 3 * b.dot(b)) / 5,
            (a.dot(d) + 9 * b.dot(c)) / 10,
            (2 * b.dot(d) + 3 * c.dot(c)) / 5,
            c.dot(d),
            d.dot(d)};
  }
  static double per_mass(const Layout<D>& layout, const Vec& mass, int node) {
    return node < 0 || layout.count(node) == 0 ? 0 : 1 / mass[layout.first(node)];
  }

  std::vector<Spring> springs_;
};

}  // namespace qddot
