#include "qddot/measure/trend/student.hpp"

#include <boost/math/distributions/students_t.hpp>

namespace qddot::inline measure {

double student_half_width(double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), 0.975);
}

}  // namespace qddot::inline measure
