#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/linkage_chart.hpp"
#include "tests/linkage_integrator.hpp"

namespace qddot {
inline namespace tests {

// The motion of point masses on rods, springs, dashpots and supports, by code that shares only the
// Scene with qddot. Directions of rods are coordinates (LinkageChart), so that lengths stay. The
// accelerations are those of Gauss's principle: they differ least from free ones, by mass. Each
// long step (ExtrapolatedStep) has a chart of its own.
class LinkageMotion {
 public:
  using Real = LinkageChart::Real;
  using Vector = LinkageChart::Vector;
  using Matrix = LinkageChart::Matrix;
  using Point = LinkageChart::Point;
  using Points = LinkageChart::Points;

  // The tolerance is that of a step, relative to coordinates of about 1 and to the largest rate.
  explicit LinkageMotion(const Scene& scene, Real tolerance = 1e-16L)
      : scene_(scene), tolerance_(tolerance), chart_(scene) {
    const Eigen::Index count = std::ssize(scene_.nodes);
    x_ = v_ = a_ = Points::Zero(3, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      x_.col(i) = node(i).position.cast<Real>();
      if (!node(i).pinned) v_.col(i) = node(i).velocity.cast<Real>();
    }
    begin(0, 0, 0);
  }

  // Moves the start [rad, m], and its rates relative to the largest one, by up to `by`: a random
  // number for each independent coordinate.
  void disturb(Real by, unsigned seed = 1) { begin(by, by, seed); }

  // Steps from where it is to `until` [s]; false if why_stopped() says why it cannot.
  bool advance(Real until);

  // The reason why the motion goes no farther; empty if it does.
  const std::string& why_stopped() const { return why_stopped_; }
  Real t() const { return t_; }
  const Points& positions() const { return x_; }
  const Points& velocities() const { return v_; }
  const Points& accelerations() const { return a_; }
  Eigen::Vector3d position(std::size_t node) const { return x_.col(index(node)).cast<double>(); }
  Eigen::Vector3d velocity(std::size_t node) const { return v_.col(index(node)).cast<double>(); }
  // The force of each rod now [N], positive if it pulls; zero for springs.
  const Vector& tensions() const { return tensions_; }
  // The largest part of forces that no tension explains, over the largest force.
  Real unexplained() const { return unexplained_; }
  // The energies of motion, springs, weights and constant loads [J], without those of supports.
  Real energy() const;
  Eigen::Index freedoms() const { return chart_.freedoms(); }

  // Sizes of the motion at the ends of steps so far: the largest distance from the start [m], speed
  // [m/s] and turn of a rod [rad/s].
  Real farthest() const { return farthest_; }
  Real fastest() const { return fastest_; }
  Real fastest_turn() const { return fastest_turn_; }
  // A bound of the fastest vibration by springs and by tensions [rad/s], and of dashpots' and air's
  // rate of decay [1/s].
  Real fastest_vibration() const { return std::sqrt(largest_square_); }
  Real fastest_decay() const { return fastest_decay_; }
  // The largest tension or compression of a rod [N].
  Real largest_tension() const { return largest_tension_; }
  // The worst conditioning of closed loops (LinkageChart::conditioning), and the work.
  Real conditioning() const { return conditioning_; }
  int steps() const { return steps_; }
  std::int64_t evaluations() const { return evaluations_; }

 private:
  static constexpr int most_steps = 100'000;

  static Eigen::Index index(std::size_t node) { return static_cast<Eigen::Index>(node); }
  const qddot::Node& node(Eigen::Index i) const {
    return scene_.nodes[static_cast<std::size_t>(i)];
  }
  bool moves(std::size_t i) const { return !is_support(scene_.nodes[i]); }

  void begin(Real by, Real faster, unsigned seed);
  Points forces(Real t, const Points& x, const Points& v) const;
  void add_spring(const qddot::Spring& spring, const Points& x, const Points& v, Points& f) const;
  std::optional<Vector> accelerate(Real t, const Vector& w, const Vector& rate);
  std::optional<Vector> slope(Real t, const Vector& y);
  bool stop(const std::string& why) {
    why_stopped_ = why;
    return false;
  }
  // Leaves the state of the chart as the present one.
  bool arrive(Real t, const Vector& y);
  void find_tensions();
  void note_sizes();
  void note_vibrations();

  const Scene scene_;
  Real tolerance_, t_ = 0, h_ = 0;
  LinkageChart chart_;
  Points x_{}, v_{}, a_{}, start_{};
  Vector tensions_{};
  std::string why_stopped_{};
  Real unexplained_ = 0, farthest_ = 0, fastest_ = 0, fastest_turn_ = 0, largest_square_ = 0;
  Real fastest_decay_ = 0, conditioning_ = 1, largest_tension_ = 0;
  int steps_ = 0;
  std::int64_t evaluations_ = 0;
};

// Lays the start on all rods: the independent coordinates and rates stay but for a disturbance, the
// dependent ones follow.
inline void LinkageMotion::begin(Real by, Real faster, unsigned seed) {
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    if (moves(i) && !(scene_.nodes[i].mass > 0)) stop("massless nodes");
    if (moves(i) || scene_.nodes[i].curve < 0) continue;
    const auto all =
        curve_and_rates(scene_.curves[static_cast<std::size_t>(scene_.nodes[i].curve)], 0);
    x_.col(index(i)) = scene_.nodes[i].position.cast<Real>() + all.col(0);
    v_.col(index(i)) = all.col(1);
  }
  if (!chart_.center(0, x_, v_)) stop("near a singular position");
  conditioning_ = std::min(conditioning_, chart_.conditioning());
  if (!why_stopped_.empty()) return;
  const Eigen::Index n = chart_.freedoms();
  std::mt19937_64 random(seed);
  const auto any = [&] { return static_cast<Real>(random() >> 11) * 0x1p-52L - 1; };
  const Real scale = n > 0 ? std::max(Real(1), chart_.rates().cwiseAbs().maxCoeff()) : 1;
  Vector y(2 * n);
  for (Eigen::Index c = 0; c < n; ++c) {
    y[c] = by * any();
    y[n + c] = chart_.rates()[c] + faster * scale * any();
  }
  if (!arrive(0, y)) return;
  start_ = x_;
  note_sizes();
}

inline bool LinkageMotion::advance(Real until) {
  if (!why_stopped_.empty()) return false;
  if (h_ == 0) h_ = (until - t_) / 32;
  const Eigen::Index n = chart_.freedoms();
  while (until - t_ > 0) {
    if (++steps_ > most_steps) return stop("too many steps");
    if (!chart_.center(t_, x_, v_)) return stop("near a singular position");
    conditioning_ = std::min(conditioning_, chart_.conditioning());
    Vector y = Vector::Zero(2 * n), sizes = Vector::Ones(2 * n);
    y.tail(n) = chart_.rates();
    if (n > 0) sizes.tail(n).setConstant(std::max(Real(1), y.tail(n).cwiseAbs().maxCoeff()));
    const bool is_last = h_ >= until - t_;
    const Real h = is_last ? until - t_ : h_;
    const auto result = ExtrapolatedStep::step(
        [&](Real t, const Vector& at) { return slope(t, at); }, t_, y, h, tolerance_, sizes);
    const bool is_done = result.is_whole && result.error <= 1;
    const Real next = h * (result.is_whole ? result.stretch : 0.5L);
    // The rest of the way says nothing about the next step.
    h_ = is_done && is_last ? std::max(h_ < 2 * h ? next : h_, next) : next;
    if (is_done && arrive(is_last ? until : t_ + h, result.y)) {
      note_sizes();
      continue;
    }
    why_stopped_.clear();
    if (is_done) h_ = h / 2;
    if (h_ < 1e-9L * until) return stop("near a singular position");
  }
  return true;
}

inline bool LinkageMotion::arrive(Real t, const Vector& y) {
  const Eigen::Index n = chart_.freedoms();
  const std::optional<Vector> second = accelerate(t, y.head(n), y.tail(n));
  if (!second) return stop("near a singular position");
  t_ = t;
  x_ = chart_.positions();
  v_ = chart_.velocities();
  a_.reshaped() = chart_.slopes() * *second + chart_.bend();
  find_tensions();
  return true;
}

inline std::optional<LinkageMotion::Vector> LinkageMotion::slope(Real t, const Vector& y) {
  const Eigen::Index n = chart_.freedoms();
  const std::optional<Vector> second = accelerate(t, y.head(n), y.tail(n));
  if (!second) return {};
  Vector both(2 * n);
  both << y.tail(n), *second;
  return both;
}

// The second derivatives of the coordinates: least squares of sqrt(m) (x'' - F/m) over all nodes.
inline std::optional<LinkageMotion::Vector> LinkageMotion::accelerate(Real t, const Vector& w,
                                                                      const Vector& rate) {
  ++evaluations_;
  if (!chart_.move_to(t, w, rate)) return {};
  const Points f = forces(t, chart_.positions(), chart_.velocities());
  Matrix left = chart_.slopes();
  Vector right = -chart_.bend();
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    const Real mass = moves(i) ? scene_.nodes[i].mass : 0, root = std::sqrt(mass);
    auto own = right.segment(3 * index(i), 3);
    if (mass > 0) own += f.col(index(i)) / mass;
    own *= root;
    left.middleRows(3 * index(i), 3) *= root;
  }
  if (chart_.freedoms() == 0) return Vector(0);
  return Vector(left.householderQr().solve(right));
}

// Weights, loads, springs, dashpots and air.
inline LinkageMotion::Points LinkageMotion::forces(Real t, const Points& x, const Points& v) const {
  Points f = Points::Zero(3, x.cols());
  for (const qddot::Spring& spring : scene_.springs) {
    if (!spring.law.rigid) add_spring(spring, x, v, f);
  }
  Point gravity = scene_.gravity.cast<Real>();
  const auto curve = [&](int number) {
    return Point(curve_and_rates(scene_.curves[static_cast<std::size_t>(number)], t).col(0));
  };
  if (scene_.gravity_curve >= 0) gravity += curve(scene_.gravity_curve);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Real mass = node(i).mass;
    f.col(i) += mass * gravity + node(i).load.cast<Real>() -
                static_cast<Real>(scene_.air_damping) * mass * v.col(i);
    if (!node(i).pinned && node(i).curve >= 0) f.col(i) += curve(node(i).curve);
  }
  return f;
}

inline void LinkageMotion::add_spring(const qddot::Spring& spring, const Points& x, const Points& v,
                                      Points& f) const {
  const SpringLaw& law = spring.law;
  const Real k = law.stiffness, rest = law.rest_length, c = law.damping;
  const Eigen::Index i = index(spring.nodes[0]), j = index(spring.nodes[1]);
  const Point d = x.col(j) - x.col(i), w = v.col(j) - v.col(i);
  Point force = k * d + c * w;
  if (rest > 0) {
    const Real l = d.norm();
    force = d / l * (k * (l - rest) + c * d.dot(w) / l);
  }
  f.col(i) += force;
  f.col(j) -= force;
}

// Tensions that add up to m x'' - F at each node that moves, by least squares.
inline void LinkageMotion::find_tensions() {
  std::vector<std::size_t> rods;
  for (std::size_t e = 0; e < scene_.springs.size(); ++e) {
    const auto [i, j] = scene_.springs[e].nodes;
    if (scene_.springs[e].law.rigid && (moves(i) || moves(j))) rods.push_back(e);
  }
  tensions_ = Vector::Zero(std::ssize(scene_.springs));
  unexplained_ = 0;
  if (rods.empty()) return;
  Matrix pulls = Matrix::Zero(3 * x_.cols(), std::ssize(rods));
  for (std::size_t r = 0; r < rods.size(); ++r) {
    const auto [i, j] = scene_.springs[rods[r]].nodes;
    const Point n = (x_.col(index(j)) - x_.col(index(i))).normalized();
    if (moves(i)) pulls.col(index(r)).segment(3 * index(i), 3) = n;
    if (moves(j)) pulls.col(index(r)).segment(3 * index(j), 3) = -n;
  }
  const Points f = forces(t_, x_, v_);
  Points missing = Points::Zero(3, x_.cols());
  Real size = std::numeric_limits<Real>::min();
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    if (!moves(i)) continue;
    missing.col(index(i)) = Real(scene_.nodes[i].mass) * a_.col(index(i)) - f.col(index(i));
    size = std::max({size, f.col(index(i)).norm(), missing.col(index(i)).norm()});
  }
  const Vector all = missing.reshaped();
  const Vector solved = pulls.householderQr().solve(all);
  for (std::size_t r = 0; r < rods.size(); ++r) tensions_[index(rods[r])] = solved[index(r)];
  unexplained_ = (all - pulls * solved).cwiseAbs().maxCoeff() / size;
}

inline LinkageMotion::Real LinkageMotion::energy() const {
  Real sum = 0;
  for (Eigen::Index i = 0; i < x_.cols(); ++i) {
    if (node(i).pinned) continue;
    const Real mass = node(i).mass;
    sum += mass * v_.col(i).squaredNorm() / 2 -
           x_.col(i).dot(mass * scene_.gravity.cast<Real>() + node(i).load.cast<Real>());
  }
  for (const qddot::Spring& spring : scene_.springs) {
    if (spring.law.rigid) continue;
    const auto [i, j] = spring.nodes;
    const Real s = (x_.col(index(j)) - x_.col(index(i))).norm() - Real(spring.law.rest_length);
    sum += Real(spring.law.stiffness) * s * s / 2;
  }
  return sum;
}

inline void LinkageMotion::note_sizes() {
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
    if (!moves(i)) continue;
    farthest_ = std::max(farthest_, (x_.col(index(i)) - start_.col(index(i))).norm());
    fastest_ = std::max(fastest_, v_.col(index(i)).norm());
  }
  for (const qddot::Spring& spring : scene_.springs) {
    if (!spring.law.rigid) continue;
    const auto [i, j] = spring.nodes;
    fastest_turn_ = std::max(
        fastest_turn_, (v_.col(index(j)) - v_.col(index(i))).norm() / Real(spring.law.rest_length));
  }
  if (tensions_.size() > 0)
    largest_tension_ = std::max(largest_tension_, tensions_.cwiseAbs().maxCoeff());
  note_vibrations();
}

// Gershgorin's bound of a node's stiffness over its mass, with tensions as those of strings.
inline void LinkageMotion::note_vibrations() {
  std::vector<Real> squares(scene_.nodes.size()), decays(scene_.nodes.size(), scene_.air_damping);
  for (std::size_t e = 0; e < scene_.springs.size(); ++e) {
    const SpringLaw& law = scene_.springs[e].law;
    const auto [i, j] = scene_.springs[e].nodes;
    const Real l = (x_.col(index(j)) - x_.col(index(i))).norm();
    const Real k = law.rigid ? std::abs(tensions_[index(e)]) / l
                             : law.stiffness * std::max(Real(1), std::abs(1 - law.rest_length / l));
    for (const std::size_t end : {i, j}) {
      if (!moves(end)) continue;
      squares[end] += 2 * k / scene_.nodes[end].mass;
      decays[end] += 2 * law.damping / scene_.nodes[end].mass;
    }
  }
  for (std::size_t i = 0; i < squares.size(); ++i) {
    largest_square_ = std::max(largest_square_, squares[i]);
    fastest_decay_ = std::max(fastest_decay_, decays[i]);
  }
}

}  // namespace tests
}  // namespace qddot
