#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "qddot/model/capabilities.hpp"

// Systems that are no spring networks, as a user with a force law of his own would write them. They
// are a chain in the plane between two pins, with neighbours bound by Lennard and Jones' law
//   V(r) = e ((s/r)^12 - 2 (s/r)^6),  e = 1 J, at rest at s = 1 m, where V'' = 72 N/m.

namespace qddot {
inline namespace tests {

// The chain by V and f alone.
class Chain : public System {
 public:
  // `bonds`, `weight`: what part of either counts.
  explicit Chain(Vec mass = Vec::Ones(8), double bonds = 1, double weight = 1)
      : System(std::move(mass)), bonds_(bonds), weight_(weight) {}

  double potential(const At& at) const override {
    double v = 0;
    for (Index b = 0; b <= nodes(); ++b) {
      const double p = std::pow(between(at.q, b).norm(), -6);
      v += bonds_ * (p * p - 2 * p);
    }
    for (Index i = 0; i < nodes(); ++i) v += weight_ * gravity * at.q[2 * i + 1];
    return v;
  }
  void force(const At& at, MutableVec f) const override {
    f.setZero();
    for (Index i = 0; i < nodes(); ++i) f[2 * i + 1] = -weight_ * gravity;
    for (Index b = 0; b <= nodes(); ++b) {
      const Eigen::Vector2d d = between(at.q, b), pull = slope(d.norm()) / d.norm() * d;
      if (b > 0) f.segment<2>(2 * (b - 1)) += pull;
      if (b < nodes()) f.segment<2>(2 * b) -= pull;
    }
  }

 protected:
  static constexpr double gravity = 1;  // [N] of each node

  Index nodes() const { return size() / 2; }
  // The vector from node b - 1 to node b; the first and the last node are the pins.
  Eigen::Vector2d between(const Vec& q, Index b) const {
    const auto place = [&](Index i) -> Eigen::Vector2d {
      if (i < 0 || i == nodes()) return {static_cast<double>(i + 1), 0};
      return q.segment<2>(2 * i);
    };
    return place(b) - place(b - 1);
  }
  // V' [N] and V'' [N/m] of a bond of length r.
  double slope(double r) const { return bonds_ * 12 * (std::pow(r, -7) - std::pow(r, -13)); }
  double curvature(double r) const {
    return bonds_ * 12 * (13 * std::pow(r, -14) - 7 * std::pow(r, -8));
  }

 private:
  double bonds_, weight_;
};

// The same with K.
class ChainWithStiffness : public Chain {
 public:
  explicit ChainWithStiffness(Vec mass = Vec::Ones(8), double bonds = 1, double weight = 1)
      : Chain(std::move(mass), bonds, weight), pattern_(size(), size()) {
    for (Index column = 0; column < size(); ++column) {
      const Index after_neighbour = 2 * (column / 2 + 2);
      for (Index row = column; row < std::min(after_neighbour, size()); ++row) {
        pattern_.insert(row, column) = 0;
      }
    }
    pattern_.makeCompressed();
  }

  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  void stiffness(const At& at, SymmetricMatrix& k) const override {
    k.coeffs().setZero();
    const auto add = [&](Index i, Index j, const Eigen::Matrix2d& block) {
      for (int c = 0; c < 2; ++c) {
        for (int r = i == j ? c : 0; r < 2; ++r) k.coeffRef(2 * i + r, 2 * j + c) += block(r, c);
      }
    };
    for (Index b = 0; b <= nodes(); ++b) {
      const Eigen::Vector2d d = between(at.q, b);
      const double r = d.norm(), across = slope(r) / r;
      const Eigen::Matrix2d block = across * Eigen::Matrix2d::Identity() +
                                    (curvature(r) - across) / (r * r) * (d * d.transpose());
      if (b > 0) add(b - 1, b - 1, -block);
      if (b < nodes()) add(b, b, -block);
      if (b > 0 && b < nodes()) add(b, b - 1, block);
    }
  }

 private:
  SymmetricMatrix pattern_;
};

// Adds Gonzalez' discrete gradient, for any potential: the force in the middle, corrected along b -
// a by the missing work.
template <class Base>
class WithGradient : public Base, public DiscreteGradient {
 public:
  using Base::Base;
  const DiscreteGradient* discrete_gradient() const override { return this; }
  void mean_force(const At& a, const At& b, MutableVec f) const override {
    this->force(Vec((a.q + b.q) / 2), f);
    const Vec way = b.q - a.q;
    const double square = way.squaredNorm();
    if (square == 0) return;
    f += (this->potential(a) - this->potential(b) - f.dot(way)) / square * way;
  }
};

// The chain with its bonds named stiff, and its weight soft.
class DividedChain final : public WithGradient<ChainWithStiffness> {
 public:
  const Split* split() const override { return &split_; }

 private:
  Split split_{std::make_shared<ChainWithStiffness>(Vec::Ones(8), 1, 0),
               std::make_shared<ChainWithStiffness>(Vec::Ones(8), 0, 1),
               std::make_shared<ChainWithStiffness>(Vec::Ones(8), 1, 0),
               {0, 1, 2, 3, 4, 5, 6, 7}};
};

}  // namespace tests
}  // namespace qddot
