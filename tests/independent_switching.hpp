#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot {
inline namespace tests {

// The state of a spring in the independent model. A plain spring is taut until it is gone.
enum class Hold : std::uint8_t { taut, slack, gone };

// A spring that went slack, taut or broke.
struct HoldChange {
  long double t;  // [s]
  std::size_t spring;
  Hold to;
  long double strain, energy;  // there; [J]
  long double rate;            // l' [m/s]
  bool is_at_start;            // it began at the end of a phase, so that a small rate says nothing
};

// The motion of a scene whose springs go slack and break, by code that shares only the Scene with
// qddot: plain loops in long double, and steps of Fehlberg's pair of order 8(7) (NASA TR R-287,
// 1968). In a step all springs keep their holds, so that forces are smooth. Lengths are looked at
// in each accepted step. If one passes the end of its hold, a shorter step from the same start ends
// there: the step's length is found by Newton's method within a bracket.
class SwitchingMotion {
 public:
  using Real = long double;
  using Vector = std::vector<Real>;

  // The tolerance is that of a step, relative to sizes of about 1 m and 1 m/s. The default one is
  // ten roundings.
  explicit SwitchingMotion(const Scene& scene, Real tolerance = 1e-18L)
      : tolerance_(tolerance), dimension_(static_cast<std::size_t>(scene.dimension)) {
    air_ = scene.air_damping;
    for (const qddot::Node& node : scene.nodes) add_node(node, scene.gravity);
    for (const qddot::Spring& spring : scene.springs) add_spring(spring);
    holds_.resize(springs_.size(), Hold::taut);
    least_margin_.resize(springs_.size(), std::numeric_limits<Real>::infinity());
    most_strain_.resize(springs_.size(), -1);
    set_holds();
  }

  // Moves the start along one axis of a node [m] and [m/s].
  void displace(std::size_t node, std::size_t axis, Real by, Real faster) {
    y_[node * dimension_ + axis] += by;
    y_[count() + node * dimension_ + axis] += faster;
    set_holds();
  }

  // Steps from where it is to `until` [s]; false if that takes too many steps or changes.
  bool advance(Real until) {
    Real step = (until - t_) / 64;
    for (int i = 0; i < most_steps; ++i) {
      if (std::ssize(changes_) > most_changes) return false;
      if (change_what_is_due()) continue;
      if (!(until - t_ > 0)) return true;
      const bool is_last = step >= until - t_;
      const Real h = is_last ? until - t_ : step;
      const Real error = try_step(h) / tolerance_;
      const Real factor = 0.9L * std::pow(std::max(error, Real(1e-30L)), -1.0L / 8);
      step = h * std::clamp(factor, Real(0.2L), Real(3));
      if (!(error <= 1)) continue;
      const std::optional<Hit> hit = first_hit(h);
      y_ = hit ? at(hit->s) : end_;
      t_ = hit ? t_ + hit->s : is_last ? until : t_ + h;
      if (hit) change(hit->end);
      note_sizes();
    }
    return false;
  }

  Real t() const { return t_; }
  Eigen::Vector3d position(std::size_t node) const { return vector_at(node * dimension_); }
  Eigen::Vector3d velocity(std::size_t node) const {
    return vector_at(count() + node * dimension_);
  }
  // The changes of holds, ascending in time.
  const std::vector<HoldChange>& changes() const { return changes_; }
  Real released() const { return released_; }
  // The energies of motion, springs, weights and loads [J].
  Real energy() const;
  // The largest distance from the start, and the largest speed, of any node so far.
  Real farthest() const { return farthest_; }
  Real fastest() const { return fastest_; }
  // The largest strain of a spring at the ends of steps; -1 if it has none.
  Real most_strain(std::size_t spring) const { return most_strain_[spring]; }
  // How close a spring came to the end of its hold without passing it [m], where its length turned.
  Real least_margin(std::size_t spring) const { return least_margin_[spring]; }
  // The smallest |l'| of a change [m/s], but for those at the start.
  Real smallest_rate() const {
    Real smallest = std::numeric_limits<Real>::infinity();
    for (const HoldChange& one : changes_) {
      if (!one.is_at_start) smallest = std::min(smallest, std::abs(one.rate));
    }
    return smallest;
  }
  // The smallest time between changes that are apart by more than `tie` [s].
  Real smallest_gap(Real tie) const {
    Real smallest = std::numeric_limits<Real>::infinity();
    for (std::size_t i = 1; i < changes_.size(); ++i) {
      const Real gap = changes_[i].t - changes_[i - 1].t;
      if (gap > tie) smallest = std::min(smallest, gap);
    }
    return smallest;
  }

 private:
  struct Mass {
    bool moves;
    Real mass;
    std::array<Real, 3> pull;  // weight and load [N]
  };
  struct Line {
    std::size_t i, j;
    Real k, b, c, l0, dashpot, breaking_length;
    bool is_cable;
  };
  // The end of a spring's hold.
  struct End {
    std::size_t spring;
    Hold to;
  };
  struct Hit {
    Real s;
    End end;
  };
  struct Length {
    Real l, rate;
  };

  static constexpr int most_steps = 200'000, most_changes = 5'000, samples = 16;
  static constexpr std::size_t stages = 13;

  std::size_t count() const { return masses_.size() * dimension_; }
  Eigen::Vector3d vector_at(std::size_t first) const {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (std::size_t d = 0; d < dimension_; ++d)
      x[static_cast<Eigen::Index>(d)] = static_cast<double>(y_[first + d]);
    return x;
  }

  void add_node(const qddot::Node& node, const Eigen::Vector3d& gravity) {
    Mass mass{!node.pinned, node.mass, {}};
    const std::size_t velocities = y_.size() / 2;
    for (std::size_t d = 0; d < dimension_; ++d) {
      const auto axis = static_cast<Eigen::Index>(d);
      mass.pull[d] = Real(node.mass) * gravity[axis] + node.load[axis];
      y_.insert(y_.begin() + static_cast<std::ptrdiff_t>(velocities + d), node.position[axis]);
      y_.push_back(node.pinned ? 0 : node.velocity[axis]);
    }
    masses_.push_back(mass);
  }

  void add_spring(const qddot::Spring& spring) {
    const SpringLaw& law = spring.law;
    const Real l0 = law.rest_length;
    // The longest length is what the double numbers say, as 1 + breaks_at is no double.
    const Real breaking = std::isfinite(law.breaks_at) ? l0 * (1 + Real(law.breaks_at))
                                                       : std::numeric_limits<Real>::infinity();
    springs_.push_back({spring.nodes[0], spring.nodes[1], law.stiffness, law.cubic, law.quartic, l0,
                        law.damping, breaking, law.pulls_only && law.rest_length > 0});
  }

  Length length(const Line& line, const Vector& y) const {
    Real square = 0, product = 0;
    for (std::size_t d = 0; d < dimension_; ++d) {
      const std::size_t a = line.i * dimension_ + d, b = line.j * dimension_ + d;
      const Real x = y[b] - y[a];
      square += x * x;
      product += x * (y[count() + b] - y[count() + a]);
    }
    const Real l = std::sqrt(square);
    return {l, l > 0 ? product / l : 0};
  }
  static Real energy_of(const Line& line, Real l) {
    const Real s = l - line.l0;
    return s * s * (line.k / 2 + line.b * s / 3 + line.c * s * s / 4);
  }

  void derivative(const Vector& y, Vector& rate) const;
  void add_spring_force(const Line& line, const Vector& y, Vector& rate) const;

  // Leaves the state after h in end_ and that of each stage in stage_; returns the error.
  Real try_step(Real h);
  // The state after s from the present one, with the present holds.
  Vector at(Real s) {
    if (s == 0) return y_;
    try_step(s);
    return end_;
  }

  // Calls see(end) for each end that the spring's hold may have.
  template <class See>
  void for_each_end(std::size_t spring, const See& see) const {
    const Line& line = springs_[spring];
    if (holds_[spring] == Hold::gone) return;
    if (holds_[spring] == Hold::slack) return see(End{spring, Hold::taut});
    if (line.is_cable) see(End{spring, Hold::slack});
    if (std::isfinite(line.breaking_length)) see(End{spring, Hold::gone});
  }
  // How far the length is from the end of the hold [m], and how that changes [m/s].
  Length margin(const End& end, const Vector& y) const {
    const Line& line = springs_[end.spring];
    const auto [l, rate] = length(line, y);
    if (end.to == Hold::slack) return {l - line.l0, rate};
    return {(end.to == Hold::gone ? line.breaking_length : line.l0) - l, -rate};
  }

  void set_holds() {
    for (std::size_t e = 0; e < springs_.size(); ++e) {
      if (!springs_[e].is_cable) continue;
      const auto [l, rate] = length(springs_[e], y_);
      holds_[e] =
          l < springs_[e].l0 || (l == springs_[e].l0 && rate < 0) ? Hold::slack : Hold::taut;
    }
    start_ = y_;
    note_sizes();
  }

  bool change_what_is_due() {
    std::optional<End> due;
    for (std::size_t e = 0; e < springs_.size(); ++e) {
      for_each_end(e, [&](const End& end) {
        const auto [left, rate] = margin(end, y_);
        const bool breaks_at_start = end.to == Hold::gone && left < 0;
        if (!due && (breaks_at_start || (left <= 0 && rate < 0))) due = end;
      });
    }
    if (due) change(*due);
    return due.has_value();
  }

  void change(const End& end) {
    const Line& line = springs_[end.spring];
    const auto [l, rate] = length(line, y_);
    const bool is_gone = end.to == Hold::gone;
    const Real energy = is_gone ? energy_of(line, l) : 0;
    holds_[end.spring] = end.to;
    released_ += energy;
    // Starts are at rest lengths to a rounding of doubles, or millimetres away from them.
    const bool is_at_start = t_ < 1e-7L;
    changes_.push_back({t_, end.spring, end.to, l / line.l0 - 1, energy, rate, is_at_start});
  }

  void note_sizes();
  std::optional<Hit> first_hit(Real h);
  std::vector<End> close_ends() const;
  // The first sample below zero of an end's margins. The minimum is looked for between two samples
  // where they turn.
  void look_for(const End& end, const std::vector<Vector>& states, Real h,
                std::optional<Hit>& first);
  std::optional<Real> below_between(const End& end, Real a, Real b);
  Real root(const End& end, Real a, Real b);

  Real tolerance_, air_ = 0, t_ = 0, released_ = 0, farthest_ = 0, fastest_ = 0;
  std::size_t dimension_;
  std::vector<Mass> masses_;
  std::vector<Line> springs_;
  std::vector<Hold> holds_;
  std::vector<HoldChange> changes_;
  Vector y_, end_, start_;  // positions, then velocities
  std::vector<Real> least_margin_, most_strain_;
  std::array<Vector, stages> slope_{}, stage_{};
};

inline SwitchingMotion::Real SwitchingMotion::energy() const {
  Real sum = 0;
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    if (!masses_[i].moves) continue;
    for (std::size_t d = 0; d < dimension_; ++d) {
      const Real x = y_[i * dimension_ + d], v = y_[count() + i * dimension_ + d];
      sum += masses_[i].mass * v * v / 2 - masses_[i].pull[d] * x;
    }
  }
  for (std::size_t e = 0; e < springs_.size(); ++e) {
    if (holds_[e] == Hold::taut) sum += energy_of(springs_[e], length(springs_[e], y_).l);
  }
  return sum;
}

inline void SwitchingMotion::derivative(const Vector& y, Vector& rate) const {
  rate.assign(y.size(), 0);
  for (std::size_t e = 0; e < springs_.size(); ++e) {
    if (holds_[e] == Hold::taut) add_spring_force(springs_[e], y, rate);
  }
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    for (std::size_t d = 0; d < dimension_; ++d) {
      const std::size_t x = i * dimension_ + d, v = count() + x;
      rate[x] = y[v];
      rate[v] =
          masses_[i].moves ? (rate[v] + masses_[i].pull[d]) / masses_[i].mass - air_ * y[v] : 0;
    }
  }
}

inline void SwitchingMotion::add_spring_force(const Line& line, const Vector& y,
                                              Vector& rate) const {
  const auto [l, l_rate] = length(line, y);
  const Real s = l - line.l0;
  Real along = s * (line.k + line.b * s + line.c * s * s), across = 0;
  if (line.l0 == 0) {
    across = line.dashpot;
  } else {
    along += line.dashpot * l_rate;
  }
  for (std::size_t d = 0; d < dimension_; ++d) {
    const std::size_t a = line.i * dimension_ + d, b = line.j * dimension_ + d;
    Real force = across * (y[count() + b] - y[count() + a]);
    if (l > 0) force += along / l * (y[b] - y[a]);
    rate[count() + a] += force;
    rate[count() + b] -= force;
  }
}

inline SwitchingMotion::Real SwitchingMotion::try_step(Real h) {
  using Row = std::array<Real, stages>;
  static const std::array<Row, stages> a{{
      {},
      {2 / 27.0L},
      {1 / 36.0L, 1 / 12.0L},
      {1 / 24.0L, 0, 1 / 8.0L},
      {5 / 12.0L, 0, -25 / 16.0L, 25 / 16.0L},
      {1 / 20.0L, 0, 0, 1 / 4.0L, 1 / 5.0L},
      {-25 / 108.0L, 0, 0, 125 / 108.0L, -65 / 27.0L, 125 / 54.0L},
      {31 / 300.0L, 0, 0, 0, 61 / 225.0L, -2 / 9.0L, 13 / 900.0L},
      {2, 0, 0, -53 / 6.0L, 704 / 45.0L, -107 / 9.0L, 67 / 90.0L, 3},
      {-91 / 108.0L, 0, 0, 23 / 108.0L, -976 / 135.0L, 311 / 54.0L, -19 / 60.0L, 17 / 6.0L,
       -1 / 12.0L},
      {2383 / 4100.0L, 0, 0, -341 / 164.0L, 4496 / 1025.0L, -301 / 82.0L, 2133 / 4100.0L,
       45 / 82.0L, 45 / 164.0L, 18 / 41.0L},
      {3 / 205.0L, 0, 0, 0, 0, -6 / 41.0L, -3 / 205.0L, -3 / 41.0L, 3 / 41.0L, 6 / 41.0L, 0},
      {-1777 / 4100.0L, 0, 0, -341 / 164.0L, 4496 / 1025.0L, -289 / 82.0L, 2193 / 4100.0L,
       51 / 82.0L, 33 / 164.0L, 12 / 41.0L, 0, 1},
  }};
  static const Row weights{0,           0,           0,          0,          0,
                           34 / 105.0L, 9 / 35.0L,   9 / 35.0L,  9 / 280.0L, 9 / 280.0L,
                           0,           41 / 840.0L, 41 / 840.0L};
  const auto add_slopes = [&](const Row& row, std::size_t many, Vector& y) {
    y = y_;
    for (std::size_t j = 0; j < many; ++j) {
      if (row[j] == 0) continue;
      const Real part = h * row[j];
      for (std::size_t c = 0; c < y.size(); ++c) y[c] += part * slope_[j][c];
    }
  };
  for (std::size_t i = 0; i < stages; ++i) {
    add_slopes(a[i], i, stage_[i]);
    derivative(stage_[i], slope_[i]);
  }
  add_slopes(weights, stages, end_);
  Real error = 0;
  for (std::size_t c = 0; c < end_.size(); ++c) {
    const Real own = slope_[0][c] + slope_[10][c] - slope_[11][c] - slope_[12][c];
    const Real part = std::abs(h * 41 / 840.0L * own);
    if (!(part <= error)) error = part;  // a number that is none is an error, too
  }
  return error;
}

inline void SwitchingMotion::note_sizes() {
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    Real way = 0, speed = 0;
    for (std::size_t d = 0; d < dimension_; ++d) {
      const std::size_t x = i * dimension_ + d;
      way += (y_[x] - start_[x]) * (y_[x] - start_[x]);
      speed += y_[count() + x] * y_[count() + x];
    }
    farthest_ = std::max(farthest_, std::sqrt(way));
    fastest_ = std::max(fastest_, std::sqrt(speed));
  }
  for (std::size_t e = 0; e < springs_.size(); ++e) {
    if (springs_[e].l0 > 0)
      most_strain_[e] = std::max(most_strain_[e], length(springs_[e], y_).l / springs_[e].l0 - 1);
  }
}

// Ends that a spring may reach in the step: closer than twice what its length changes by from stage
// to stage.
inline std::vector<SwitchingMotion::End> SwitchingMotion::close_ends() const {
  std::vector<End> close;
  for (std::size_t e = 0; e < springs_.size(); ++e) {
    for_each_end(e, [&](const End& end) {
      Real least = margin(end, end_).l, most = least;
      for (const Vector& y : stage_) {
        const Real own = margin(end, y).l;
        least = std::min(least, own);
        most = std::max(most, own);
      }
      if (least < 2 * (most - least)) close.push_back(end);
    });
  }
  return close;
}

inline std::optional<SwitchingMotion::Hit> SwitchingMotion::first_hit(Real h) {
  const std::vector<End> close = close_ends();
  if (close.empty()) return {};
  std::vector<Vector> states = {y_};
  const Vector last = end_;
  for (int k = 1; k < samples; ++k) states.push_back(at(h * k / samples));
  states.push_back(last);
  std::optional<Hit> first;
  for (const End& end : close) look_for(end, states, h, first);
  end_ = last;
  return first;
}

inline void SwitchingMotion::look_for(const End& end, const std::vector<Vector>& states, Real h,
                                      std::optional<Hit>& first) {
  const auto time = [&](std::size_t k) { return h * Real(k) / samples; };
  Length before = margin(end, states[0]);
  for (std::size_t k = 1; k <= samples; ++k) {
    if (first && time(k - 1) >= first->s) return;
    const Length now = margin(end, states[k]);
    const bool turns = before.rate < 0 && now.rate >= 0;
    std::optional<Real> below;
    if (now.l < 0) {
      below = time(k);
    } else if (turns) {
      below = below_between(end, time(k - 1), time(k));
    }
    if (below) {
      const Real s = root(end, time(k - 1), *below);
      if (!first || s < first->s) first = Hit{s, end};
      return;
    }
    before = now;
  }
}

// A time between two at which a margin that has a minimum there is below zero; nothing if it is
// not, and then the minimum is noted.
inline std::optional<SwitchingMotion::Real> SwitchingMotion::below_between(const End& end, Real a,
                                                                           Real b) {
  Real least = std::numeric_limits<Real>::infinity();
  for (int i = 0; i < 60 && b - a > 0; ++i) {
    const Real middle = (a + b) / 2;
    const auto [left, rate] = margin(end, at(middle));
    if (left < 0) return middle;
    least = std::min(least, left);
    (rate < 0 ? a : b) = middle;
  }
  Real& noted = least_margin_[end.spring];
  noted = std::min(noted, least);
  return {};
}

// The moment between a and b at which the margin passes zero, to the last digit.
inline SwitchingMotion::Real SwitchingMotion::root(const End& end, Real a, Real b) {
  Real s = b;
  for (int i = 0; i < 200; ++i) {
    const auto [left, rate] = margin(end, at(s));
    (left < 0 ? b : a) = s;
    Real next = rate < 0 ? s - left / rate : (a + b) / 2;
    if (std::abs(next - s) <= 1e-19L * (t_ + s)) return std::min(next, b);
    if (!(next > a && next < b)) next = (a + b) / 2;
    if (next == a || next == b) break;
    s = next;
  }
  return b;
}

}  // namespace tests
}  // namespace qddot
