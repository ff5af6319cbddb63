#pragma once

#include <vector>

#include "qddot/model/driven_network.hpp"

namespace qddot {

// The rods of a network in dimension D as constraints. With d = x_j - x_i, or point - x_i, and the
// length L of a rod,
//   g = (|d|^2 - L^2) / (2 L)
// At g = 0 its gradients are the unit vectors +-d/L, so that lambda is the rod's tension [N].
template <int D>
class Rods final : public Constraints {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  // Keeps references to layout and curves, which must outlive it.
  Rods(const Network& network, const Layout<D>& layout, const DrivenNetwork<D>& driven)
      : driven_(driven) {
    std::vector<Eigen::Triplet<double>> entries;
    compliances_.resize(std::ssize(network.rods));
    for (const Network::Rod& rod : network.rods) {
      const int i = layout.first(rod.i), j = rod.j < 0 ? -1 : layout.first(rod.j);
      for (int a = 0; a < D; ++a) {
        const auto k = static_cast<int>(rods_.size());
        entries.emplace_back(k, i + a, 0);
        if (j >= 0) entries.emplace_back(k, j + a, 0);
      }
      compliances_[std::ssize(rods_)] = rod.compliance;
      rods_.push_back({i, j, rod.point.template head<D>(), rod.length, rod.curve});
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
      const double bend = 1 / rod.length;
      for (int a = 0; a < D; ++a) {
        all.push_back({k, rod.i + a, rod.i + a, bend});
        if (rod.j < 0) continue;
        all.push_back({k, rod.j + a, rod.j + a, bend});
        all.push_back({k, std::max(rod.i, rod.j) + a, std::min(rod.i, rod.j) + a, -bend});
      }
    }
    return all;
  }

  const Vec& compliances() const override { return compliances_; }

 private:
  // i, j: first unknowns; j < 0 at a point.
  struct Rod {
    int i, j;
    Point point;
    double length;
    int curve;
  };

  static Point between(const Rod& rod, const VecView& q, const std::vector<Point>& curves) {
    if (rod.j >= 0) return q.template segment<D>(rod.j) - q.template segment<D>(rod.i);
    const Point d = rod.point - q.template segment<D>(rod.i);
    return rod.curve < 0 ? d : Point(d + curves[rod.curve]);
  }
  static Point apart(const Rod& rod, const VecView& v, const std::vector<Point>& rates) {
    if (rod.j >= 0) return v.template segment<D>(rod.j) - v.template segment<D>(rod.i);
    const Point w = -v.template segment<D>(rod.i);
    return rod.curve < 0 ? w : Point(w + rates[rod.curve]);
  }
  // Row k is d/L for the unknowns of j and -d/L for those of i, in the order of the unknowns.
  template <class Difference>
  void set_rows(GradientMatrix& rows, const Difference& difference) const {
    double* value = rows.valuePtr();
    for (const Rod& rod : rods_) {
      const Point row = difference(rod) / rod.length;
      const auto write = [&](const Point& x) { value = std::copy(x.data(), x.data() + D, value); };
      if (rod.j >= 0 && rod.j < rod.i) write(row);
      write(-row);
      if (rod.j > rod.i) write(row);
    }
  }

  const DrivenNetwork<D>& driven_;
  std::vector<Rod> rods_;
  Vec compliances_;
  GradientMatrix pattern_;
};

}  // namespace qddot
