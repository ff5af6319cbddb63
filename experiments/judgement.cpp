#include "experiments/judgement.hpp"

#include <limits>

namespace qddot {

double judged_error(const Point& point, const Reference& reference) {
  return reference.is_beyond_horizon() ? point.on_the_way.energy : point.errors.position;
}

double certified(const Reference& reference) {
  // E(0) is known exactly; what rounding makes of E at later times is the run's own.
  return reference.is_beyond_horizon() ? std::numeric_limits<double>::epsilon()
                                       : reference.certified.position;
}

const char* judged_by(const Reference& reference) {
  return reference.is_beyond_horizon() ? "energy" : "position";
}

}  // namespace qddot
