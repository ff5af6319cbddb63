#include <boost/test/unit_test.hpp>

#include "qddot/analysis/curvature_signs.hpp"
#include "qddot/analysis/equilibrium.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/linear_motion.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/analysis/stability.hpp"

BOOST_AUTO_TEST_SUITE(require_stiffness)

using namespace qddot;

namespace {

// V = |q|^2 / 2, without K.
class Plain final : public System {
 public:
  Plain() : System(Vec::Ones(2)) {}
  double potential(const ConstVec& q) const override { return 0.5 * q.squaredNorm(); }
  void force(const ConstVec& q, MutableVec f) const override { f = -q; }
};

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_computed_from_k_is_refused_where_there_is_none) {
  const Plain system;
  const Vec q = Vec::Ones(2);
  BOOST_CHECK_THROW(qddot::frequency_bound(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(largest_frequency(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(frequency_at_least(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(quick_frequency(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(lowest_modes(system, q, 1), std::invalid_argument);
  BOOST_CHECK_THROW(highest_modes(system, q, 1), std::invalid_argument);
  BOOST_CHECK_THROW(smallest_curvature(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(qddot::curvature_signs(system, q), std::invalid_argument);
  BOOST_CHECK_THROW(find_equilibrium(system, q, 1), std::invalid_argument);
  BOOST_CHECK_THROW(LinearMotion{system}, std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
