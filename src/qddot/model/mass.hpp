#pragma once

#include <utility>

#include <Eigen/Core>

namespace qddot {

// The diagonal of the lumped mass matrix M [kg], length n, with the numbers nearest to 1/m. By
// these, f/m needs no division and is rounded alike (see vectors/quotients.hpp). Entries may be
// zero (massless nodes).
class Mass : public Eigen::VectorXd {
 public:
  explicit Mass(Eigen::VectorXd m);

  // The nearest numbers to 1/m: n, or one if all masses are the same, or none if some mass is not
  // in [2^-200, 2^200].
  const Eigen::VectorXd& inverse() const { return inverse_; }
  bool is_uniform() const { return inverse_.size() == 1; }

 private:
  Eigen::VectorXd inverse_;
};

}  // namespace qddot
