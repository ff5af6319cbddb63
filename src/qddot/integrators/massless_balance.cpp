#include "qddot/integrators/massless_balance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace qddot {
namespace {

// A node has jumped if it moves this many times as far as its balance predicts. Just before a
// balance is lost, nodes move as the square root of the time left: twice as far as the first slope
// predicts. Springs with only a quartic term that become taut move nodes as the cube root: three
// times as far.
constexpr double most_times_as_far = 4;
// The largest ratio of an error that a solve leaves in soft directions to its tolerance. It is 6
// among random scenes.
constexpr double most_times_unsolved = 30;
// The part of its coordinates by which rounding moves a node: 1e-16 over the softest direction that
// still counts as stable.
constexpr double rounding = 1e-10;

}  // namespace

bool has_massless_dashpots(const System& system, const Vec& q) {
  const Damping* damping = system.damping();
  if (!damping || !damping->has_dashpots() || !system.has_massless()) return false;
  if (!system.has_stiffness()) return true;  // not known
  SymmetricMatrix c = system.stiffness_pattern();
  damping->damping_matrix(q, c);
  for (Index i = 0; i < system.size(); ++i) {
    // C is positive semidefinite: without an entry on the diagonal a row is zero.
    if (system.mass()[i] == 0 && c.valuePtr()[c.outerIndexPtr()[i]] > 0) return true;
  }
  return false;
}

MasslessBalance::MasslessBalance(const System& system, Vec start, double tolerance,
                                 double solve_tolerance)
    : driving_(system.driving()),
      tolerance_(tolerance),
      solve_tolerance_(solve_tolerance),
      start_(std::move(start)),
      massless_(static_cast<std::size_t>(system.size()), -1) {
  Index count = 0;
  for (Index i = 0; i < system.size(); ++i) {
    if (system.mass()[i] == 0) massless_[i] = count++;
  }
  SymmetricMatrix k = system.stiffness_pattern(), own(count, count);
  Index entry = 0;
  for (Index column = 0; column < k.outerSize(); ++column) {
    if (massless_[column] >= 0) own.startVec(massless_[column]);
    for (SymmetricMatrix::InnerIterator at(k, column); at; ++at, ++entry) {
      if (massless_[column] < 0 || massless_[at.row()] < 0) continue;
      if (at.row() == column) diagonals_.push_back(std::ssize(source_));
      own.insertBack(massless_[at.row()], massless_[column]) = 0;
      source_.push_back(entry);
    }
  }
  own.finalize();
  scale_.resize(count);
  pull_.resize(count);
  for (Place* place : {from_.get(), to_.get()}) {
    place->q.setConstant(system.size(), std::numeric_limits<double>::quiet_NaN());  // unknown
    place->f.resize(system.size());
    if (driving_) place->f_rate.resize(system.size());
    place->k = k;
    place->own = own;
    place->factors.analyzePattern(own);
  }
}

// Factorises -K among the massless unknowns; false unless it is positive semidefinite.
bool MasslessBalance::factorize(Place& place) {
  SymmetricMatrix& own = place.own;
  for (std::size_t e = 0; e < source_.size(); ++e) {
    own.valuePtr()[e] = -place.k.valuePtr()[source_[e]];
  }
  // A direction across a straight row of springs is soft. The tolerance is relative to the stiffest
  // direction of its node and of the node's neighbours.
  const Index count = own.cols();
  const auto diagonal = [&](Index i) { return std::abs(own.valuePtr()[diagonals_[i]]); };
  for (Index i = 0; i < count; ++i) scale_[i] = diagonal(i);
  for (Index column = 0; column < count; ++column) {
    for (SymmetricMatrix::InnerIterator at(own, column); at; ++at) {
      scale_[column] = std::max(scale_[column], diagonal(at.row()));
      scale_[at.row()] = std::max(scale_[at.row()], diagonal(column));
    }
  }
  for (Index i = 0; i < count; ++i) {
    own.valuePtr()[diagonals_[i]] += scale_[i] > 0 ? tolerance_ * scale_[i] : 1;
  }
  place.factors.factorize(own);
  return place.factors.info() == Eigen::Success && place.factors.vectorD().minCoeff() > 0;
}

// Let m stand for massless and o for other nodes. f_m = 0 at q' = (q_m', q_o') gives -K_mm (q_m' -
// q_m) = f_m(q) + K_mo (q_o' - q_o) + h df_m/dt. So nodes first come into balance, and then follow
// the others by the K of either end. When they turn, a slope is zero for an instant, but that of
// the step before is not. The error of a step's prediction is at most the nodes' path in the step
// before, and a solve leaves a part of it.
bool MasslessBalance::have_followed(double h) {
  double moved = 0;
  for (Index i = 0; i < std::ssize(massless_); ++i) {
    const Index m = massless_[i];
    if (m < 0) continue;
    moved = std::max(moved, std::abs(to_->q[i] - from_->q[i]));
    pull_[m] = from_->f[i];
  }
  const double unsolved =
      most_times_unsolved * solve_tolerance_ * std::exchange(moved_before_, moved);
  if (from_->q == start_) return true;
  if (!from_->is_stable) return false;
  const double out_of_balance = from_->factors.solve(pull_).lpNorm<Eigen::Infinity>();
  const double led_at_first = led(*from_, h);
  const double least = std::max(std::min(led_at_first, led(*to_, h)), h * speed_before_);
  speed_before_ = led_at_first / h;
  const double farthest =
      std::max(start_.lpNorm<Eigen::Infinity>(), to_->q.lpNorm<Eigen::Infinity>());
  return moved <= most_times_as_far * (least + out_of_balance) + unsolved + rounding * farthest;
}

// The displacement [m] of massless nodes by K when the others move from q_o to q_o', and forces
// change in the time h.
double MasslessBalance::led(const Place& place, double h) {
  pull_.setZero();
  for (Index i = 0; driving_ && i < std::ssize(massless_); ++i) {
    if (massless_[i] >= 0) pull_[massless_[i]] = h * place.f_rate[i];
  }
  for (Index column = 0; column < place.k.outerSize(); ++column) {
    for (SymmetricMatrix::InnerIterator at(place.k, column); at; ++at) {
      if ((massless_[at.row()] < 0) == (massless_[column] < 0)) continue;
      const Index other = massless_[column] < 0 ? column : at.row();
      const Index follower = at.row() + column - other;
      pull_[massless_[follower]] += at.value() * (to_->q[other] - from_->q[other]);
    }
  }
  return place.factors.solve(pull_).lpNorm<Eigen::Infinity>();
}

}  // namespace qddot
