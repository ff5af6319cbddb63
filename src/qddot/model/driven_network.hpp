#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "qddot/model/capabilities.hpp"
#include "qddot/model/layout.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot {

// The parts of a network that depend on time, in dimension D: moving points with the springs to
// them, and driven loads.
template <int D>
class DrivenNetwork {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  // Keeps a reference to the layout, which must outlive it.
  DrivenNetwork(const Network& network, const Layout<D>& layout)
      : layout_(layout), curves_(network.curves) {
    for (const auto& load : network.driven_loads) {
      loads_.push_back({load.i, load.curve, load.factor, load.origin.head<D>()});
    }
    for (const auto& anchor : network.anchors) {
      if (anchor.curve >= 0) {
        anchors_.push_back({anchor.i, anchor.curve, anchor.point.head<D>(), anchor.law, -1});
      }
    }
    for (const auto& spring : network.general) {
      if (spring.curve < 0) continue;
      anchors_.push_back(
          {spring.i, spring.curve, spring.point.head<D>(), spring.law, spring.number});
    }
  }

  bool is_driven() const { return !curves_.empty(); }
  bool has_loads() const { return !loads_.empty(); }

  // A time of curves; see At.
  struct Time {
    explicit Time(const At& at)
        : t(std::isnan(at.t) ? 0 : at.t), within(std::isnan(at.within) ? t : at.within) {}
    explicit Time(double time) : t(time), within(time) {}
    double t, within;
  };

  // The values of all curves; none if nothing is driven. A t that is NaN is the start, 0.
  std::vector<Point> values(const Time& time) const { return of_all(&TimeCurve::at, time); }
  std::vector<Point> values(const At& at) const {
    return is_driven() ? values(Time(at)) : std::vector<Point>();
  }
  std::vector<Point> rates(const Time& time) const { return of_all(&TimeCurve::rate, time); }
  std::vector<Point> accelerations(const At& at) const {
    return of_all(&TimeCurve::acceleration, Time(at));
  }
  std::vector<Point> rates(const At& at) const {
    return is_driven() ? rates(Time(at)) : std::vector<Point>();
  }

  // Adds the driven loads to f.
  void add_loads(const At& at, MutableVec f) const {
    if (has_loads()) add_loads(values(at), f);
  }
  // Their potential energy [J].
  double load_energy(const At& at) const { return has_loads() ? load_energy(values(at), at.q) : 0; }

  Work power(const At& at) const {
    const std::vector<Point> s = values(at), s_rate = rates(at);
    Work power{.driven = load_energy(s_rate, at.q)};
    for (const Anchor& anchor : anchors_) {
      if (!acts(anchor, at.phases)) continue;
      const Point d = anchor.point + s[anchor.curve] - layout_.at(at.q, anchor.i);
      const Point& w = s_rate[anchor.curve];
      // The spring pulls its node by tau n, and the support by -tau n.
      const SpringLaw law = law_of(anchor, at.phases);
      power.driven += spring_force(law, d).dot(w);
      if (law.damping == 0 || at.v.size() == 0) continue;
      const Point apart = w - layout_.at(at.v, anchor.i);
      const double given = dashpot_force(law, d, apart).dot(w);
      power += Work{given, given};
    }
    return power;
  }

  double potential_change(double from, double to, const At& at) const {
    const VecView& q = at.q;
    const std::vector<Point> before = values(Time(from)), after = values(Time(to));
    double change = load_energy(after, q) - load_energy(before, q);
    for (const Anchor& anchor : anchors_) {
      if (!acts(anchor, at.phases)) continue;
      const Point rest = anchor.point - layout_.at(q, anchor.i);
      const SpringLaw law = law_of(anchor, at.phases);
      change += spring_energy(law, Point(rest + after[anchor.curve])) -
                spring_energy(law, Point(rest + before[anchor.curve]));
    }
    return change;
  }

  void force_rate(const At& at, MutableVec rate) const {
    const std::vector<Point> s = values(at), s_rate = rates(at);
    rate.setZero();
    add_loads(s_rate, rate);
    for (const Anchor& anchor : anchors_) {
      if (!acts(anchor, at.phases)) continue;
      const Point d = anchor.point + s[anchor.curve] - layout_.at(at.q, anchor.i);
      layout_.add(spring_stiffness(law_of(anchor, at.phases), d) * s_rate[anchor.curve], anchor.i,
                  rate);
    }
  }

  std::vector<Corner> corners() const {
    std::vector<Corner> all;
    std::vector<bool> meets_dashpots(curves_.size(), false), is_used(curves_.size(), false);
    for (const Load& load : loads_) is_used[static_cast<std::size_t>(load.curve)] = true;
    for (const Anchor& anchor : anchors_) {
      is_used[static_cast<std::size_t>(anchor.curve)] = true;
      if (anchor.law.damping > 0) meets_dashpots[static_cast<std::size_t>(anchor.curve)] = true;
    }
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      if (!is_used[c]) continue;
      for (const Corner& corner : curves_[c].corners()) {
        all.push_back({corner.t, corner.order - meets_dashpots[c]});
      }
    }
    std::ranges::sort(all, {}, &Corner::t);
    return all;
  }

  // The forces of time alone, for springs whose forces are k d + constant: those of rest length
  // zero, and `constant` (n) those at q = 0 with all curves at zero.
  std::optional<Forcing> forcing(double t, const Vec& constant) const {
    Forcing all;
    std::vector<Vec> at_point(1, constant);
    const auto derivative = [&](std::size_t k) -> Vec& {
      while (at_point.size() <= k) at_point.emplace_back(Vec::Zero(constant.size()));
      return at_point[k];
    };
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      const TimeCurve& curve = curves_[c];
      if (!curve.own.empty()) return {};
      const int number = static_cast<int>(c);
      const auto spread = [&](const Eigen::Vector3d& value, bool by_dashpots) {
        Vec f = Vec::Zero(constant.size());
        const Point x = value.head<D>();
        for (const Load& load : loads_) {
          if (load.curve == number && !by_dashpots) layout_.add(load.factor * x, load.i, f);
        }
        for (const Anchor& anchor : anchors_) {
          if (anchor.curve != number) continue;
          layout_.add((by_dashpots ? anchor.law.damping : anchor.law.stiffness) * x, anchor.i, f);
        }
        return f;
      };
      for (const auto& [amplitude, frequency, phase] : curve.harmonics) {
        all.harmonics.push_back({frequency, phase, spread(amplitude, false)});
        const Vec damped = spread(frequency * amplitude, true);
        if (!damped.isZero(0))
          all.harmonics.push_back({frequency, phase + std::numbers::pi / 2, damped});
      }
      const std::vector<Eigen::Vector3d> of_curve = polynomial_at(curve, t);
      for (std::size_t k = 0; k < of_curve.size(); ++k) {
        derivative(k) += spread(of_curve[k], false);
        if (k > 0) derivative(k - 1) += spread(of_curve[k], true);
      }
    }
    all.derivatives = std::move(at_point);
    return all;
  }

 private:
  struct Load {
    int i, curve;
    double factor;
    Point origin;
  };
  struct Anchor {
    int i, curve;
    Point point;
    SpringLaw law;
    int number;  // of its phase, or -1
  };

  // Whether the spring is in the network.
  static bool acts(const Anchor& anchor, const Phase* phases) {
    if (anchor.number < 0 || !phases) return true;
    const Phase phase = phases[anchor.number];
    return phase != Phase::slack && phase != Phase::broken;
  }
  static SpringLaw law_of(const Anchor& anchor, const Phase* phases) {
    SpringLaw law = anchor.law;
    if (anchor.number >= 0 && phases && phases[anchor.number] == Phase::taut)
      law.pulls_only = false;
    return law;
  }

  using Function = Eigen::Vector3d (TimeCurve::*)(double, double) const;
  std::vector<Point> of_all(Function function, const Time& time) const {
    std::vector<Point> all;
    all.reserve(curves_.size());
    for (const TimeCurve& curve : curves_) {
      all.push_back((curve.*function)(time.t, time.within).template head<D>());
    }
    return all;
  }

  void add_loads(const std::vector<Point>& s, MutableVec f) const {
    for (const Load& load : loads_) layout_.add(load.factor * s[load.curve], load.i, f);
  }
  double load_energy(const std::vector<Point>& s, const VecView& q) const {
    double energy = 0;
    for (const Load& load : loads_) {
      energy -= load.factor * s[load.curve].dot(layout_.at(q, load.i) - load.origin);
    }
    return energy;
  }

  // The derivatives of a curve without harmonics, at t.
  static std::vector<Eigen::Vector3d> polynomial_at(const TimeCurve& curve, double t) {
    std::vector<Eigen::Vector3d> all = curve.polynomial;
    // Horner's scheme, repeated: each pass leaves one coefficient of powers of s - t.
    double factorial = 1;
    for (std::size_t k = 0; k < all.size(); ++k) {
      for (std::size_t i = all.size() - 1; i-- > k;) all[i] += t * all[i + 1];
    }
    for (std::size_t k = 2; k < all.size(); ++k) all[k] *= factorial *= static_cast<double>(k);
    for (const PiecewiseCubic& table : curve.tables) {
      const auto derivatives = table.derivatives(t, t);
      if (all.size() < derivatives.size()) all.resize(derivatives.size(), Eigen::Vector3d::Zero());
      for (std::size_t k = 0; k < derivatives.size(); ++k) all[k] += derivatives[k];
    }
    return all;
  }

  const Layout<D>& layout_;
  std::vector<TimeCurve> curves_;
  std::vector<Load> loads_;
  std::vector<Anchor> anchors_;
};

}  // namespace qddot
