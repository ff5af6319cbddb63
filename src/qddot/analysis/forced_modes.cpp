#include "qddot/analysis/forced_modes.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace qddot {

ForcedModes::ForcedModes(const Vec& squares, const Vec& gamma, const Forcing& forcing,
                         double duration)
    : duration_(duration), terms_(forcing.derivatives.size()) {
  for (const Forcing::Harmonic& harmonic : forcing.harmonics) {
    const double w = harmonic.frequency;
    frequencies_.push_back(w);
    harmonics_.push_back(response(squares, gamma, Eigen::Matrix2d{{0, w}, {-w, 0}}));
  }
  // The k-th force begins as 1 at place k and is integrated down to place 0, which pushes.
  const auto terms = static_cast<Index>(std::max<std::size_t>(terms_, 1));
  Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(terms, terms);
  for (Index k = 0; k + 1 < terms; ++k) chain(k, k + 1) = 1;
  polynomial_ = response(squares, gamma, chain);
  steady_ = polynomial_;
}

bool ForcedModes::is_for(const Forcing& forcing, double duration) const {
  return duration == duration_ && forcing.derivatives.size() == terms_ &&
         std::ranges::equal(forcing.harmonics, frequencies_, {}, &Forcing::Harmonic::frequency);
}

ForcedModes::Response ForcedModes::response(const Vec& squares, const Vec& gamma,
                                            const Eigen::MatrixXd& of_force) const {
  const Index kinds = of_force.cols(), size = 2 + kinds;
  Response all{{static_cast<std::size_t>(kinds), Vec(squares.size())}, {}};
  all.rate = all.y;
  Eigen::MatrixXd a(size, size);
  for (Index j = 0; j < squares.size(); ++j) {
    const double damping = gamma.size() > 0 ? 2 * gamma[j] : 0;
    // With y in units of `unit` squared and y' in units of it, no entry is much larger than others.
    const double unit = 1 / std::max({std::sqrt(std::abs(squares[j])), damping, 1 / duration_});
    a.setZero();
    a(0, 1) = 1 / unit;
    a(1, 0) = -squares[j] * unit;
    a(1, 1) = -damping;
    a(1, 2) = 1 / unit;
    a.bottomRightCorner(kinds, kinds) = of_force;
    const Eigen::MatrixXd after = (duration_ * a).exp();
    for (Index k = 0; k < kinds; ++k) {
      all.y[static_cast<std::size_t>(k)][j] = unit * unit * after(0, 2 + k);
      all.rate[static_cast<std::size_t>(k)][j] = unit * after(1, 2 + k);
    }
  }
  return all;
}

}  // namespace qddot
