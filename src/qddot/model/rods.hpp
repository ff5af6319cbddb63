#pragma once

#include <vector>

#include "qddot/model/driven_network.hpp"

namespace qddot {

// The rods of a network in dimension D as constraints. With d = S x_j - x_i, where S mirrors, or
// d = point - x_i, and the length L of a rod,
//   g = (|d|^2 - L^2) / (2 L)
// d is affine in q: the sum of terms s q_u e_a over unknowns u. At g = 0 the gradients without
// mirrors are the unit vectors +-d/L, so that lambda is the rod's tension [N].
template <int D>
class Rods final : public Constraints {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  // Keeps a reference to the curves, which must outlive it.
  Rods(const Network& network, const Layout<D>& layout, const DrivenNetwork<D>& driven)
      : driven_(driven) {
    std::vector<Eigen::Triplet<double>> entries;
    compliances_.resize(std::ssize(network.rods));
    for (const Network::Rod& rod : network.rods) {
      const auto k = static_cast<int>(rods_.size());
      const std::size_t first = terms_.size();
      add_terms(rod, layout);
      for (std::size_t t = first; t < terms_.size(); ++t)
        entries.emplace_back(k, terms_[t].unknown, 0);
      compliances_[k] = rod.compliance;
      rods_.push_back({first, terms_.size(), rod.point.template head<D>(), rod.length, rod.curve});
    }
    if (compliances_.isZero(0)) compliances_.resize(0);
    pattern_.resize(std::ssize(rods_), layout.first(static_cast<int>(layout.nodes())));
    pattern_.setFromTriplets(entries.begin(), entries.end());
  }

  bool empty() const { return rods_.empty(); }

  Index constraint_count() const override { return std::ssize(rods_); }
  const GradientMatrix& gradient_pattern() const override { return pattern_; }

  void constraint_values(const At& at, MutableVec g) const override {
    const std::vector<Point> curves = driven_.values(at);
    for (std::size_t k = 0; k < rods_.size(); ++k) {
      const double length = rods_[k].length, l = between(rods_[k], at.q, curves).norm();
      g[static_cast<Index>(k)] = (l - length) * (l + length) / (2 * length);
    }
  }
  void constraint_gradients(const At& at, GradientMatrix& gradients) const override {
    const std::vector<Point> curves = driven_.values(at);
    set_rows(gradients, [&](const Rod& rod) { return between(rod, at.q, curves); });
  }
  void gradient_rates(const At& at, GradientMatrix& rates) const override {
    const std::vector<Point> curves = driven_.rates(at);
    set_rows(rates, [&](const Rod& rod) { return apart(rod, at.v, curves); });
  }
  void constraint_rates(const At& at, MutableVec rates) const override {
    rates.setZero();
    if (!driven_.is_driven()) return;
    const std::vector<Point> curves = driven_.values(at), speeds = driven_.rates(at);
    for (std::size_t k = 0; k < rods_.size(); ++k) {
      const Rod& rod = rods_[k];
      if (rod.curve < 0) continue;
      rates[static_cast<Index>(k)] = between(rod, at.q, curves).dot(speeds[rod.curve]) / rod.length;
    }
  }
  void constraint_accelerations(const At& at, MutableVec accelerations) const override {
    const std::vector<Point> curves = driven_.values(at), speeds = driven_.rates(at);
    const std::vector<Point> bends =
        driven_.is_driven() ? driven_.accelerations(at) : std::vector<Point>();
    for (std::size_t k = 0; k < rods_.size(); ++k) {
      const Rod& rod = rods_[k];
      double sum = apart(rod, at.v, speeds).squaredNorm();
      if (rod.curve >= 0) sum += between(rod, at.q, curves).dot(bends[rod.curve]);
      accelerations[static_cast<Index>(k)] = sum / rod.length;
    }
  }
  std::vector<Curvature> curvatures() const override {
    std::vector<Curvature> all;
    for (Index k = 0; k < std::ssize(rods_); ++k) {
      const Rod& rod = rods_[static_cast<std::size_t>(k)];
      for (std::size_t s = rod.first; s < rod.end; ++s) {
        for (std::size_t t = rod.first; t <= s; ++t) {
          if (terms_[s].axis != terms_[t].axis) continue;
          const double value = terms_[s].factor * terms_[t].factor / rod.length;
          all.push_back({k, terms_[s].unknown, terms_[t].unknown, value});
        }
      }
    }
    return all;
  }

  const Vec& compliances() const override { return compliances_; }

 private:
  // factor q_unknown e_axis.
  struct Term {
    int unknown, axis;
    double factor;
  };
  // The terms of d from `first` to before `end`, beside a point, which may move by a curve.
  struct Rod {
    std::size_t first, end;
    Point point;
    double length;
    int curve;
  };

  // Appends the terms of d, in the order of the unknowns. Those of a node and its own image add up.
  void add_terms(const Network::Rod& rod, const Layout<D>& layout) {
    const auto add = [&](int node, const Point& factors) {
      for (int a = 0; a < layout.count(node); ++a) {
        const int axis = layout.axis(node, a);
        if (factors[axis] != 0) terms_.push_back({layout.first(node) + a, axis, factors[axis]});
      }
    };
    const Point image = rod.image.template head<D>(), minus = Point::Constant(-1);
    if (rod.j == rod.i) return add(rod.i, image + minus);
    if (rod.j >= 0 && rod.j < rod.i) add(rod.j, image);
    add(rod.i, minus);
    if (rod.j > rod.i) add(rod.j, image);
  }

  Point sum(const Rod& rod, const VecView& x, Point d) const {
    for (std::size_t t = rod.first; t < rod.end; ++t)
      d[terms_[t].axis] += terms_[t].factor * x[terms_[t].unknown];
    return d;
  }
  Point between(const Rod& rod, const VecView& q, const std::vector<Point>& curves) const {
    return sum(rod, q, rod.curve < 0 ? rod.point : Point(rod.point + curves[rod.curve]));
  }
  Point apart(const Rod& rod, const VecView& v, const std::vector<Point>& rates) const {
    return sum(rod, v, rod.curve < 0 ? Point(Point::Zero()) : rates[rod.curve]);
  }
  template <class Difference>
  void set_rows(GradientMatrix& rows, const Difference& difference) const {
    double* value = rows.valuePtr();
    for (const Rod& rod : rods_) {
      const Point row = difference(rod) / rod.length;
      for (std::size_t t = rod.first; t < rod.end; ++t)
        *value++ = terms_[t].factor * row[terms_[t].axis];
    }
  }

  const DrivenNetwork<D>& driven_;
  std::vector<Rod> rods_;
  std::vector<Term> terms_;
  Vec compliances_;
  GradientMatrix pattern_;
};

}  // namespace qddot
