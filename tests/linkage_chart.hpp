#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

#include "tests/linkage_curves.hpp"

namespace qddot {
inline namespace tests {

// Coordinates of point masses that rods join, in long double. A spanning forest of rods hangs from
// supports and free roots. Directions of its rods and positions of its roots are coordinates, whose
// origin is the present state. In the plane a direction n(a) is turned by the angle a. In space it
// is n0 + a e1 + b e2 over its length. Rods beside the forest close loops: Newton's method solves
// their equations for as many dependent coordinates, and the others are independent.
class LinkageChart {
 public:
  using Real = long double;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Point = Eigen::Matrix<Real, 3, 1>;
  using Points = Eigen::Matrix<Real, 3, Eigen::Dynamic>;  // a node a column
  using Index = Eigen::Index;

  explicit LinkageChart(const Scene& scene);

  // The number of independent coordinates.
  Index freedoms() const { return tree_size_ - std::ssize(closures_); }
  // Puts the origin at a state and chooses the dependent coordinates anew; tells whether they are
  // far enough from a singular position.
  bool center(Real t, const Points& x, const Points& v);
  // The rates of the independent coordinates at the origin.
  const Vector& rates() const { return rates_; }
  // Computes everything below for independent coordinates and their rates; false if there are no
  // such positions nearby.
  bool move_to(Real t, const Vector& w, const Vector& rate);

  const Points& positions() const { return x_; }
  const Points& velocities() const { return v_; }
  // Accelerations are slopes() w'' + bend(), node after node.
  const Matrix& slopes() const { return slopes_; }
  const Vector& bend() const { return bend_; }
  // The smallest pivot of the closures' slopes over the largest one, at the origin; 1 without any.
  Real conditioning() const { return conditioning_; }

 private:
  // A node, and the rod to its parent or the root's own coordinates.
  struct Branch {
    enum Kind { support, root, link } kind;
    std::size_t node, parent;
    Real length;
    Index first;  // of its coordinates
    // The direction at the origin and two across.
    Point n0 = Point::Zero(), e1 = n0, e2 = n0;
  };
  struct Closure {
    std::size_t i, j;
    Real length;
  };

  static constexpr Real singular = 0.02L, largest_turn = 1;

  void span(const Scene& scene);
  void add_rods_of(const Scene& scene, std::size_t node, std::deque<std::size_t>& open);
  void set_supports(Real t);
  // The direction of a rod at the tree's coordinates u, and its derivatives by them.
  Point direction(const Branch& branch, const Vector& u, Matrix& by_u) const;
  // The second derivative by time of a direction with straight coordinates.
  Point direction_bend(const Branch& branch, const Vector& u, const Vector& rate) const;
  void place(const Vector& u);
  void move(const Vector& u, const Vector& rate);
  Vector gaps() const;
  Matrix gap_slopes() const;
  bool close(Vector& u);
  void choose_dependents();
  void follow(const Vector& u, Vector& u_rate);
  // The component of a difference between the ends of a rod along it.
  Real along(const Closure& rod, const Points& y) const {
    const Index i = column(rod.i), j = column(rod.j);
    return (x_.col(j) - x_.col(i)).dot(y.col(j) - y.col(i)) / rod.length;
  }
  // The own rows of the node in a matrix of all nodes.
  static Index row(std::size_t node) { return 3 * static_cast<Index>(node); }
  static Index column(std::size_t node) { return static_cast<Index>(node); }

  Index dimension_, tree_size_ = 0;
  const std::vector<qddot::Node> nodes_;
  const std::vector<TimeCurve> curves_;
  std::vector<Branch> branches_{};  // parents before children
  std::vector<Closure> closures_{};
  std::vector<bool> is_reached_{}, is_used_{};
  std::vector<Index> dependent_{}, independent_{};
  Points x_, v_, a_;  // a: with straight coordinates
  Points carried_;    // what supports give to each node's velocity
  Points support_{}, support_rate_{}, support_bend_{};
  Matrix j_{}, slopes_{};  // of positions by the tree's coordinates and by the independent ones
  Vector bend_{}, rates_{};
  Real conditioning_ = 1;
};

inline LinkageChart::LinkageChart(const Scene& scene)
    : dimension_(scene.dimension), nodes_(scene.nodes), curves_(scene.curves) {
  const Index count = std::ssize(nodes_);
  x_ = v_ = a_ = carried_ = Points::Zero(3, count);
  support_ = support_rate_ = support_bend_ = Points::Zero(3, count);
  is_reached_.resize(nodes_.size());
  is_used_.resize(scene.springs.size());
  span(scene);
}

// Goes along rods from all supports, then from each node that is not reached.
inline void LinkageChart::span(const Scene& scene) {
  std::deque<std::size_t> open;
  const auto finish = [&] {
    while (!open.empty()) {
      const std::size_t node = open.front();
      open.pop_front();
      add_rods_of(scene, node, open);
    }
  };
  const auto begin = [&](std::size_t node, Branch::Kind kind) {
    branches_.push_back({kind, node, node, 0, tree_size_});
    if (kind == Branch::root) tree_size_ += dimension_;
    is_reached_[node] = true;
    open.push_back(node);
  };
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (is_support(nodes_[i])) begin(i, Branch::support);
  }
  finish();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (is_reached_[i]) continue;
    begin(i, Branch::root);
    finish();
  }
}

// Adds links to nodes that are not reached, and closures to others.
inline void LinkageChart::add_rods_of(const Scene& scene, std::size_t node,
                                      std::deque<std::size_t>& open) {
  for (std::size_t e = 0; e < scene.springs.size(); ++e) {
    const std::array<std::size_t, 2>& nodes = scene.springs[e].nodes;
    const SpringLaw& law = scene.springs[e].law;
    if (!law.rigid || is_used_[e] || (nodes[0] != node && nodes[1] != node)) continue;
    const std::size_t other = nodes[0] == node ? nodes[1] : nodes[0];
    is_used_[e] = true;
    if (is_support(nodes_[node]) && is_support(nodes_[other])) continue;
    if (is_reached_[other]) {
      closures_.push_back({node, other, law.rest_length});
      continue;
    }
    branches_.push_back({Branch::link, other, node, law.rest_length, tree_size_});
    tree_size_ += dimension_ - 1;
    is_reached_[other] = true;
    open.push_back(other);
  }
}

// The positions of supports at t, and their first two derivatives.
inline void LinkageChart::set_supports(Real t) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!is_support(nodes_[i])) continue;
    support_.col(column(i)) = nodes_[i].position.cast<Real>();
    if (nodes_[i].curve < 0) continue;
    const auto all = curve_and_rates(curves_[static_cast<std::size_t>(nodes_[i].curve)], t);
    support_.col(column(i)) += all.col(0);
    support_rate_.col(column(i)) = all.col(1);
    support_bend_.col(column(i)) = all.col(2);
  }
}

inline LinkageChart::Point LinkageChart::direction(const Branch& branch, const Vector& u,
                                                   Matrix& by_u) const {
  by_u = Matrix::Zero(3, dimension_ - 1);
  if (dimension_ == 1) return branch.n0;
  const Real a = u[branch.first];
  if (dimension_ == 2) {
    by_u.col(0) = branch.e1 * std::cos(a) - branch.n0 * std::sin(a);
    return branch.n0 * std::cos(a) + branch.e1 * std::sin(a);
  }
  const Point p = branch.n0 + a * branch.e1 + u[branch.first + 1] * branch.e2;
  const Real size = p.norm();
  const Point n = p / size;
  by_u.col(0) = (branch.e1 - n * n.dot(branch.e1)) / size;
  by_u.col(1) = (branch.e2 - n * n.dot(branch.e2)) / size;
  return n;
}

inline LinkageChart::Point LinkageChart::direction_bend(const Branch& branch, const Vector& u,
                                                        const Vector& rate) const {
  if (dimension_ == 1) return Point::Zero();
  const Real a = u[branch.first], a_rate = rate[branch.first];
  if (dimension_ == 2)
    return -a_rate * a_rate * (branch.n0 * std::cos(a) + branch.e1 * std::sin(a));
  // n = p/s has n' = (p' - s' n)/s with s' = n.p', and p'' = 0.
  const Point p = branch.n0 + a * branch.e1 + u[branch.first + 1] * branch.e2;
  const Point p_rate = a_rate * branch.e1 + rate[branch.first + 1] * branch.e2;
  const Real s = p.norm();
  const Point n = p / s;
  const Real s_rate = n.dot(p_rate);
  const Point n_rate = (p_rate - s_rate * n) / s;
  return -(2 * s_rate * n_rate + n_rate.dot(p_rate) * n) / s;
}

// Positions of all nodes, and their slopes by the tree's coordinates.
inline void LinkageChart::place(const Vector& u) {
  j_ = Matrix::Zero(3 * x_.cols(), tree_size_);
  Matrix by_u;
  for (const Branch& branch : branches_) {
    const Index own = column(branch.node), up = column(branch.parent);
    if (branch.kind == Branch::support) {
      x_.col(own) = support_.col(own);
      carried_.col(own) = support_rate_.col(own);
    } else if (branch.kind == Branch::root) {
      x_.col(own) = branch.n0;
      x_.col(own).head(dimension_) += u.segment(branch.first, dimension_);
      j_.block(row(branch.node), branch.first, dimension_, dimension_).setIdentity();
      carried_.col(own).setZero();
    } else {
      x_.col(own) = x_.col(up) + branch.length * direction(branch, u, by_u);
      j_.middleRows(row(branch.node), 3) = j_.middleRows(row(branch.parent), 3);
      j_.block(row(branch.node), branch.first, 3, dimension_ - 1) += branch.length * by_u;
      carried_.col(own) = carried_.col(up);
    }
  }
}

// Velocities, and accelerations with straight coordinates, where place() was.
inline void LinkageChart::move(const Vector& u, const Vector& rate) {
  const Vector own_rate = j_ * rate;
  for (const Branch& branch : branches_) {
    const Index own = column(branch.node), up = column(branch.parent);
    v_.col(own) = carried_.col(own) + own_rate.segment(row(branch.node), 3);
    if (branch.kind == Branch::support) a_.col(own) = support_bend_.col(own);
    if (branch.kind == Branch::root) a_.col(own).setZero();
    if (branch.kind == Branch::link)
      a_.col(own) = a_.col(up) + branch.length * direction_bend(branch, u, rate);
  }
}

// (|d|^2 - l^2)/(2 l) of each rod that closes a loop.
inline LinkageChart::Vector LinkageChart::gaps() const {
  Vector all(std::ssize(closures_));
  for (std::size_t c = 0; c < closures_.size(); ++c) {
    const auto& [i, j, length] = closures_[c];
    const Real far = (x_.col(column(j)) - x_.col(column(i))).norm();
    all[column(c)] = (far - length) * (far + length) / (2 * length);
  }
  return all;
}

// The derivatives of gaps() by the tree's coordinates.
inline LinkageChart::Matrix LinkageChart::gap_slopes() const {
  Matrix all(std::ssize(closures_), tree_size_);
  for (std::size_t c = 0; c < closures_.size(); ++c) {
    const auto& [i, j, length] = closures_[c];
    const Point d = (x_.col(column(j)) - x_.col(column(i))) / length;
    all.row(column(c)) = d.transpose() * (j_.middleRows(row(j), 3) - j_.middleRows(row(i), 3));
  }
  return all;
}

// Solves the closures for the dependent coordinates in u, to the last digits.
inline bool LinkageChart::close(Vector& u) {
  Real before = 1;
  for (int i = 0; i < 40; ++i) {
    place(u);
    if (closures_.empty()) return true;
    const Matrix slopes = gap_slopes();
    const Vector by = -slopes(Eigen::all, dependent_).partialPivLu().solve(gaps());
    u(dependent_) += by;
    const Real size = by.cwiseAbs().maxCoeff();
    if (!(size < largest_turn)) return false;
    // Rounding ends quadratic convergence.
    if (size < 1e-17L && (size >= before || i > 1)) {
      place(u);
      return true;
    }
    before = size;
  }
  return false;
}

inline bool LinkageChart::center(Real t, const Points& x, const Points& v) {
  set_supports(t);
  Vector u = Vector::Zero(tree_size_), rate = Vector::Zero(tree_size_);
  for (Branch& branch : branches_) {
    const Index own = column(branch.node), up = column(branch.parent);
    if (branch.kind == Branch::support) continue;
    if (branch.kind == Branch::root) {
      branch.n0 = x.col(own);
      rate.segment(branch.first, dimension_) = v.col(own).head(dimension_);
      continue;
    }
    branch.n0 = (x.col(own) - x.col(up)).normalized();
    Index least = 0;
    branch.n0.cwiseAbs().minCoeff(&least);
    branch.e1 = dimension_ == 2 ? Point(-branch.n0[1], branch.n0[0], 0)
                                : Point(branch.n0.cross(Point::Unit(least)).normalized());
    branch.e2 = branch.n0.cross(branch.e1);
    const Point turn = (v.col(own) - v.col(up)) / branch.length;
    if (dimension_ > 1) rate[branch.first] = turn.dot(branch.e1);
    if (dimension_ > 2) rate[branch.first + 1] = turn.dot(branch.e2);
  }
  place(u);
  choose_dependents();
  rates_ = rate(independent_);
  return conditioning_ > singular;
}

// Those with the largest pivots of the closures' slopes are dependent.
inline void LinkageChart::choose_dependents() {
  dependent_.clear();
  independent_.clear();
  std::vector<bool> depends(static_cast<std::size_t>(tree_size_));
  conditioning_ = 1;
  if (!closures_.empty() && std::ssize(closures_) <= tree_size_) {
    const Eigen::ColPivHouseholderQR<Matrix> factors(gap_slopes());
    for (Index c = 0; c < std::ssize(closures_); ++c) {
      dependent_.push_back(factors.colsPermutation().indices()[c]);
      depends[static_cast<std::size_t>(dependent_.back())] = true;
    }
    const Vector pivots = factors.matrixQR().diagonal().cwiseAbs();
    conditioning_ = pivots.minCoeff() / pivots.maxCoeff();
  }
  if (std::ssize(closures_) > tree_size_) conditioning_ = 0;
  for (Index c = 0; c < tree_size_; ++c) {
    if (!depends[static_cast<std::size_t>(c)]) independent_.push_back(c);
  }
}

inline bool LinkageChart::move_to(Real t, const Vector& w, const Vector& rate) {
  set_supports(t);
  Vector u = Vector::Zero(tree_size_), u_rate = u;
  u(independent_) = w;
  u_rate(independent_) = rate;
  if (!close(u)) return false;
  for (const Branch& branch : branches_) {
    if (branch.kind != Branch::link) continue;
    if (!(u.segment(branch.first, dimension_ - 1).norm() < largest_turn)) return false;
  }
  slopes_ = j_(Eigen::all, independent_);
  if (closures_.empty()) {
    move(u, u_rate);
    bend_ = a_.reshaped();
  } else {
    follow(u, u_rate);
  }
  return true;
}

// Sets velocities, slopes and bend, with the dependent coordinates as closures prescribe.
inline void LinkageChart::follow(const Vector& u, Vector& u_rate) {
  const Matrix gap_slope = gap_slopes();
  const auto factors = gap_slope(Eigen::all, dependent_).partialPivLu();
  const Matrix by_independent = -factors.solve(gap_slope(Eigen::all, independent_));
  slopes_ += j_(Eigen::all, dependent_) * by_independent;
  // Supports alone change the gaps by this.
  Vector gap_rate(std::ssize(closures_));
  for (std::size_t c = 0; c < closures_.size(); ++c)
    gap_rate[column(c)] = along(closures_[c], carried_);
  u_rate(dependent_) = by_independent * u_rate(independent_) - factors.solve(gap_rate);
  move(u, u_rate);
  // The second derivatives of gaps with straight coordinates.
  for (std::size_t c = 0; c < closures_.size(); ++c) {
    const auto& [i, j, length] = closures_[c];
    gap_rate[column(c)] =
        along(closures_[c], a_) + (v_.col(column(j)) - v_.col(column(i))).squaredNorm() / length;
  }
  bend_ = a_.reshaped();
  bend_ -= j_(Eigen::all, dependent_) * factors.solve(gap_rate);
}

}  // namespace tests
}  // namespace qddot
