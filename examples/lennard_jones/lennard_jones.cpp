// A force law that is no spring: a chain in the plane with Lennard-Jones bonds between neighbours,
// V(r) = 4 e ((s/r)^12 - (s/r)^6), charted by work and precision against a certified reference.
#include <cmath>
#include <cstdio>
#include <memory>
#include <qddot/qddot.hpp>
#include <vector>

namespace {

using Eigen::Matrix2d, Eigen::Vector2d;
using qddot::At, qddot::Index, qddot::Vec, qddot::ConstVec, qddot::MutableVec;

constexpr double e = 1, s = 1;  // [J], [m]

// dV/dr and d2V/dr2 of a bond of length r, and its energy.
struct Bond {
  explicit Bond(double r) {
    const double a = std::pow(s / r, 6);
    energy = 4 * e * (a * a - a);
    first = 24 * e * (a - 2 * a * a) / r;
    second = 24 * e * (26 * a * a - 7 * a) / (r * r);
  }
  double energy, first, second;
};

class Chain final : public qddot::System {
 public:
  explicit Chain(Index atoms)
      : System(Vec::Ones(2 * atoms)), atoms_(atoms), pattern_(size(), size()) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index i = 0; i < size(); ++i) {
      for (Index j = i; j < std::min(size(), i - i % 2 + 4); ++j) entries.emplace_back(j, i, 0);
    }
    pattern_.setFromTriplets(entries.begin(), entries.end());
  }

  double potential(const At& at) const override {
    double sum = 0;
    for (Index i = 0; i + 1 < atoms_; ++i) sum += Bond(across(at.q, i).norm()).energy;
    return sum;
  }
  void force(const At& at, MutableVec f) const override {
    f.setZero();
    for (Index i = 0; i + 1 < atoms_; ++i) {
      const Vector2d d = across(at.q, i), pull = Bond(d.norm()).first * d.normalized();
      f.segment<2>(2 * i) += pull;
      f.segment<2>(2 * i + 2) -= pull;
    }
  }
  const qddot::SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  void stiffness(const At& at, qddot::SymmetricMatrix& k) const override {
    k.coeffs().setZero();
    for (Index i = 0; i + 1 < atoms_; ++i) {
      const Vector2d d = across(at.q, i), n = d.normalized();
      const Bond bond(d.norm());
      const Matrix2d along = n * n.transpose(), all = Matrix2d::Identity();
      const Matrix2d b = bond.second * along + bond.first / d.norm() * (all - along);
      add(k, i, i, -b);
      add(k, i + 1, i + 1, -b);
      add(k, i + 1, i, b);
    }
  }

 private:
  static Vector2d across(const ConstVec& q, Index i) {
    return q.segment<2>(2 * i + 2) - q.segment<2>(2 * i);
  }
  // Into the lower triangle, which is what is stored.
  static void add(qddot::SymmetricMatrix& k, Index row, Index column, const Matrix2d& b) {
    for (Index i = 0; i < 2; ++i) {
      for (Index j = 0; j < (row == column ? i + 1 : 2); ++j)
        k.coeffRef(2 * row + i, 2 * column + j) += b(i, j);
    }
  }

  Index atoms_;
  qddot::SymmetricMatrix pattern_;
};

}  // namespace

int main() {
  constexpr Index atoms = 10;
  const auto chain = std::make_shared<const Chain>(atoms);
  qddot::State start{0, Vec::Zero(2 * atoms), Vec::Zero(2 * atoms)};
  for (Index i = 0; i < atoms; ++i) {
    start.q[2 * i] = 1.13 * s * double(i);  // about the bonds' rest length, 2^(1/6) s
    start.v[2 * i + 1] = 0.2 * std::sin(0.7 * double(i));  // a wave across
  }
  const double until = 2;  // [s]
  const auto chart = qddot::work_precision(
      {chain, start, 2}, until, {&qddot::method("arkode_dirk4"), &qddot::method("blanes_moan4")});
  std::printf("reference certified to %.1e\n", chart.reference.certified.position);
  for (const qddot::Point& point : chart.points) {
    std::printf("%-14s %-9s %9.3g  %-12s error %.1e in %.2e s\n", point.method->name.c_str(),
                knob_name(point.method->knob), point.value, name(point.outcome).data(),
                point.errors.position, point.time);
  }
}
