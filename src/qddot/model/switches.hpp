#pragma once

#include <algorithm>
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

  std::optional<Change> first_change(double t_from, const MovingNodes<D>& from, double t_to,
                                     const MovingNodes<D>& to, std::span<const Phase> phases,
                                     const Switching::Recent& recent) const {
    std::optional<Change> first;
    const double h = t_to - t_from;
    for (const Spring& spring : springs_) {
      if (spring.number == recent.but) continue;
      const bool is_recent = recent.is_recent[static_cast<std::size_t>(spring.number)];
      for_each_end(spring, phases, [&](Phase next) {
        const double bound = length_at(spring, next),
                     tolerance =
                         band * rounding_of(spring, from) + (is_recent ? recent.allowance : 0);
        const Point a = difference(spring, from), d = difference(spring, to);
        const Point b = a + h / 3 * rate(spring, from), c = d - h / 3 * rate(spring, to);
        SquaredLength inside = squared_length<D>(a, b, c, d);
        for (double& x : inside) x = next == Phase::slack ? x - bound * bound : bound * bound - x;
        const auto s = first_below(inside, -2 * bound * tolerance);
        if (s && (!first || t_from + *s * h < first->t))
          first = Change{t_from + *s * h, spring.number, next};
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
  static constexpr double roundings = 4, band = 4;

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
  std::vector<int> place_;  // of each number in springs_, or -1
  int count_ = 0;
};

}  // namespace qddot
