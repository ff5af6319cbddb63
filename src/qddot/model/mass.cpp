#include "qddot/model/mass.hpp"

namespace qddot {

Mass::Mass(Eigen::VectorXd m) : Eigen::VectorXd(std::move(m)) {
  constexpr double extreme = 0x1p200;
  if (size() == 0 || !(minCoeff() >= 1 / extreme && maxCoeff() <= extreme)) return;
  const bool is_same = (array() == (*this)[0]).all();
  inverse_ = head(is_same ? 1 : size()).cwiseInverse();
}

}  // namespace qddot
