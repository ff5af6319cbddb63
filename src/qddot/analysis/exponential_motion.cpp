#include "qddot/analysis/exponential_motion.hpp"

#include <cmath>
#include <stdexcept>
#include <unsupported/Eigen/MatrixFunctions>

#include "qddot/model/capabilities.hpp"

namespace qddot {

ExponentialMotion::ExponentialMotion(const System& system, double duration)
    : system_(system), duration_(duration) {
  const Damping* damping = system.damping();
  if (!system.has_stiffness() || !system.stiffness_is_constant() || system.has_massless() ||
      !damping || !damping->damping_is_constant() || !system.is_autonomous()) {
    throw std::invalid_argument("the exact motion needs constant K and C and positive masses");
  }
  const Index n = system.size();
  const Vec anywhere = Vec::Zero(n), per_mass = system.mass().cwiseInverse();
  SymmetricMatrix matrix = system.stiffness_pattern();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  const auto per_mass_times = [&](const SymmetricMatrix& m) -> Eigen::MatrixXd {
    return per_mass.asDiagonal() *
           Eigen::MatrixXd(Eigen::SparseMatrix<double>(m.selfadjointView<Eigen::Lower>()));
  };
  system.stiffness(anywhere, matrix);
  const Eigen::MatrixXd accelerations = per_mass_times(matrix);
  // In the unit of time in which accelerations are about as large as z, rounding is least. A power
  // of 2 rounds nothing itself.
  const double square = accelerations.cwiseAbs().rowwise().sum().maxCoeff();
  const double unit = square > 0 ? std::exp2(std::round(-0.5 * std::log2(square))) : 1;
  all.block(n, 0, n, n) = duration * unit * accelerations;
  damping->damping_matrix(anywhere, matrix);
  all.block(n, n, n, n) = -duration * per_mass_times(matrix);
  all.block(0, n, n, n).diagonal().setConstant(duration / unit);
  all.block(n, 2 * n, n, n).diagonal().setConstant(duration / unit);
  Eigen::MatrixXd exponential = all.exp();
  exponential.middleRows(n, n) /= unit;
  of_v_ = unit * exponential.block(0, n, 2 * n, n);
  of_push_ = unit * unit * exponential.block(0, 2 * n, 2 * n, n);
}

void ExponentialMotion::propagate(const State& from, State& to) const {
  const Index n = system_.size();
  Vec push(n);
  system_.force({from.t, from.q}, push);
  push = push.cwiseQuotient(system_.mass());
  const Vec z = of_v_ * from.v + of_push_ * push;
  to.t = from.t + duration_;
  to.q = from.q + z.head(n);
  to.v = z.tail(n);
}

}  // namespace qddot
