#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "qddot/model/capabilities.hpp"
#include "qddot/model/layout.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "qddot/model/mass_spring.hpp"
#include "qddot/model/squared_length.hpp"

namespace qddot {

// The places and velocities of nodes, and of points on curves, at some time.
template <int D>
struct MovingNodes {
  using Point = Eigen::Matrix<double, D, 1>;

  VecView q, v;
  std::vector<Point> curves, curve_rates;
};

// The ends of the phases of a network's springs that go slack or break, by their lengths: a cable
// goes slack or taut at l0, and a spring breaks at l0 (1 + breaks_at).
template <int D>
class Switches {
  using Point = Eigen::Matrix<double, D, 1>;
  using Change = Switching::Change;
  using Margin = Switching::Margin;

 public:
  // Keeps a reference to the layout, which must outlive it.
  Switches(const Network& network, const Layout<D>& layout) : layout_(layout) {
    for (const auto& spring : network.general) {
      if (count_ <= spring.number) count_ = spring.number + 1;
      if (!spring.law.goes_slack() && !spring.law.can_break()) continue;
      springs_.push_back(
          {spring.i, spring.j, spring.curve, spring.number, spring.point.head<D>(), spring.law});
    }
    if (!springs_.empty()) sum_stiffness(network);
    place_.assign(static_cast<std::size_t>(count_), -1);
    for (int e = 0; e < std::ssize(springs_); ++e) place_[springs_[e].number] = e;
  }

  bool empty() const { return springs_.empty(); }
  Index count() const { return count_; }

  std::optional<int> order_of_slack() const {
    std::optional<int> order;
    for (const Spring& spring : springs_) {
      if (spring.law.goes_slack())
        order = std::min(order.value_or(1), spring.law.damping > 0 ? 0 : 1);
    }
    return order;
  }

  void set_phases(const MovingNodes<D>& now, bool finds_slack, std::span<Phase> phases) const {
    for (const Spring& spring : springs_) {
      Phase& phase = phases[static_cast<std::size_t>(spring.number)];
      if (phase == Phase::broken) continue;
      phase = Phase::by_length;
      if (!finds_slack || !spring.law.goes_slack()) continue;
      const Margin margin = margin_of(spring, now, Phase::slack);
      const bool is_slack =
          std::abs(margin.length) > margin.rounding ? margin.length < 0 : margin.rate < 0;
      phase = is_slack ? Phase::slack : Phase::taut;
    }
  }

  // `pull(is_end, f)` gives the system's forces at both ends of the step, in these phases.
  template <class Pull>
  std::optional<Change> first_change(double t_from, const MovingNodes<D>& from, double t_to,
                                     const MovingNodes<D>& to, std::span<const Phase> phases,
                                     const Switching::Changed& changed, const Vec& mass,
                                     const Pull& pull) const {
    std::optional<Change> first;
    Step step{from, to, t_from, t_to - t_from, mass, {}, {}};
    for (const Spring& spring : springs_) {
      const bool has_changed = changed.has_changed[static_cast<std::size_t>(spring.number)];
      for_each_end(spring, phases, [&](Phase next) {
        const auto s = end_in_step(spring, next, step, has_changed, changed.allowance, pull);
        if (s && (!first || t_from + *s * step.h < first->t))
          first = Change{t_from + *s * step.h, spring.number, next};
      });
    }
    return first;
  }

  Margin margin(const MovingNodes<D>& now, int number, Phase to) const {
    return margin_of(springs_[place_[number]], now, to);
  }

  void add_due_changes(double t, const MovingNodes<D>& now, std::span<const Phase> phases,
                       std::vector<Change>& due) const {
    for (const Spring& spring : springs_) {
      for_each_end(spring, phases, [&](Phase next) {
        const Margin margin = margin_of(spring, now, next);
        if (margin.length <= margin.rounding && margin.rate < 0)
          due.push_back({t, spring.number, next});
      });
    }
  }

  double energy(const MovingNodes<D>& now, int number) const {
    const Spring& spring = springs_[place_[number]];
    return spring.law.energy(difference(spring, now).norm());
  }
  double strain(const MovingNodes<D>& now, int number) const {
    const Spring& spring = springs_[place_[number]];
    return difference(spring, now).norm() / spring.law.rest_length - 1;
  }

 private:
  struct Spring {
    int i, j, curve, number;
    Point point;
    SpringLaw law;
  };

  // The roundings of places that a length is believed to, and those that a spring may be beyond the
  // end of its phase. One that rests there would change its phase for ever.
  static constexpr double roundings = 4, band = 4, roundings_of_moment = 16;
  // h w up to which the cubic has an error of 2e-4 of the amplitude, and beyond which the quintic
  // tells nothing.
  static constexpr double well_resolved = 0.5, longest_resolved = 6;

  // A step, and the accelerations at its ends once something needs them.
  struct Step {
    const MovingNodes<D>&from, &to;
    double t, h;
    const Vec& mass;
    Vec a_from, a_to;
  };

  // The part of the step after which the spring's phase ends. In a step that does not resolve the
  // vibrations w of its ends well, the cubic through both ends hides short turns. There the quintic
  // tells that has both accelerations as well. Its error is (h w)^4/5760 of h^2/8 times these, so
  // that nearer turns count as ends: a step then ends there, and the next one sees more.
  template <class Pull>
  std::optional<double> end_in_step(const Spring& spring, Phase next, Step& step, bool has_changed,
                                    double allowance, const Pull& pull) const {
    const double bound = length_at(spring, next), h = step.h;
    const Point a = difference(spring, step.from), d = difference(spring, step.to);
    const Point va = rate(spring, step.from), vd = rate(spring, step.to);
    double tolerance = band * rounding_of(spring, step.from);
    if (has_changed && next != Phase::broken) {
      const Margin margin = margin_of(spring, step.from, next);
      // A moment is known to its own rounding.
      const double unsure = allowance + roundings_of_moment * machine_epsilon * std::abs(step.t) *
                                            std::abs(margin.rate);
      if (margin.length <= tolerance + unsure) tolerance += unsure;
    }
    const auto inside = [&](auto squares) {
      for (double& x : squares) x = next == Phase::slack ? x - bound * bound : bound * bound - x;
      return squares;
    };
    const SquaredLength by_cubic = inside(squared_length<D>(a, a + h / 3 * va, d - h / 3 * vd, d));
    const double turn = h * frequency(spring, step.mass);
    const double sagitta = h / 8 * (vd - va).norm();
    const bool is_resolved = turn < well_resolved || turn > longest_resolved || spring.curve >= 0;
    if (is_resolved || *std::ranges::min_element(by_cubic) > 2 * bound * (2 * sagitta + tolerance))
      return first_below(by_cubic, -2 * bound * tolerance);
    if (step.a_from.size() == 0) {
      pull(false, step.a_from);
      pull(true, step.a_to);
      for (Vec* f : {&step.a_from, &step.a_to}) *f = f->cwiseQuotient(step.mass);
    }
    const Point aa = acceleration(spring, step.a_from), ad = acceleration(spring, step.a_to);
    const auto by_quintic = inside(squared_length<D>(
        std::array<Point, 6>{a, a + h / 5 * va, a + 2 * h / 5 * va + h * h / 20 * aa,
                             d - 2 * h / 5 * vd + h * h / 20 * ad, d - h / 5 * vd, d}));
    if (const auto s = first_below(by_quintic, -2 * bound * tolerance)) return s;
    const double unseen = 2 * std::pow(turn, 4) / 5760 * h * h / 8 * std::max(aa.norm(), ad.norm());
    const double near = 2 * bound * std::min(unseen, sagitta);
    if (by_quintic.front() <= near || by_quintic.back() <= near) return {};
    return first_below(by_quintic, near);
  }

  void sum_stiffness(const Network& network) {
    stiffness_.setZero(layout_.nodes());
    const auto add = [&](const auto& springs) {
      for (const auto& spring : springs) {
        stiffness_[spring.i] += spring.law.stiffness;
        if constexpr (requires { spring.j; }) {
          if (spring.j >= 0) stiffness_[spring.j] += spring.law.stiffness;
        }
      }
    };
    add(network.links);
    add(network.image_links);
    add(network.anchors);
    add(network.general);
  }
  // A bound of the frequency of the spring's ends [rad/s], whatever else pulls them, if all other
  // nodes rest.
  double frequency(const Spring& spring, const Vec& mass) const {
    const auto square = [&](int node) {
      return node < 0 || layout_.count(node) == 0 ? 0
                                                  : stiffness_[node] / mass[layout_.first(node)];
    };
    return std::sqrt(square(spring.i) + square(spring.j));
  }
  // The acceleration of d, of a spring whose point rests.
  Point acceleration(const Spring& spring, const Vec& a) const {
    const Point own = layout_.at(a, spring.i);
    return spring.j < 0 ? Point(-own) : layout_.at(a, spring.j) - own;
  }

  // Calls see(next phase) for each end that the present phase of the spring may have.
  template <class See>
  static void for_each_end(const Spring& spring, std::span<const Phase> phases, const See& see) {
    const Phase phase = phases[static_cast<std::size_t>(spring.number)];
    if (phase == Phase::broken) return;
    if (phase == Phase::taut && spring.law.goes_slack()) see(Phase::slack);
    if (phase == Phase::slack) return see(Phase::taut);
    if (spring.law.can_break()) see(Phase::broken);
  }
  static double length_at(const Spring& spring, Phase next) {
    return spring.law.rest_length * (next == Phase::broken ? 1 + spring.law.breaks_at : 1);
  }

  Margin margin_of(const Spring& spring, const MovingNodes<D>& now, Phase next) const {
    const Point d = difference(spring, now);
    const double length = d.norm(), sign = next == Phase::slack ? 1 : -1;
    const double l_rate = length > 0 ? rate(spring, now).dot(d) / length : 0;
    return {sign * (length - length_at(spring, next)), sign * l_rate, rounding_of(spring, now)};
  }

  Point difference(const Spring& spring, const MovingNodes<D>& now) const {
    return far_end(spring, now.q, now.curves, spring.point) - layout_.at(now.q, spring.i);
  }
  Point rate(const Spring& spring, const MovingNodes<D>& now) const {
    return far_end(spring, now.v, now.curve_rates, Point::Zero()) - layout_.at(now.v, spring.i);
  }
  Point far_end(const Spring& spring, const VecView& x, const std::vector<Point>& curves,
                const Point& point) const {
    if (spring.j >= 0) return layout_.at(x, spring.j);
    return spring.curve < 0 ? point : Point(point + curves[spring.curve]);
  }
  double rounding_of(const Spring& spring, const MovingNodes<D>& now) const {
    const double size = layout_.at(now.q, spring.i).cwiseAbs().maxCoeff();
    return roundings * machine_epsilon * (size + spring.law.rest_length);
  }

  const Layout<D>& layout_;
  std::vector<Spring> springs_;
  Vec stiffness_;           // of all springs at each node, summed [N/m]
  std::vector<int> place_;  // of each number in springs_, or -1
  int count_ = 0;
};

}  // namespace qddot
