#include "qddot/measure/speed/judgement.hpp"

#include <algorithm>
#include <limits>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {

double judged_error(const Point& point, const Reference& reference) {
  if (!reference.is_beyond_horizon()) return point.errors.position;
  const bool is_another_motion =
      point.path.modal_shares > most_of_chance * reference.modal_shares_floor;
  return is_another_motion ? std::numeric_limits<double>::infinity() : point.path.energy;
}

double certified(const Reference& reference) {
  // E(0) is known exactly; what rounding makes of E at later times is the run's own.
  return reference.is_beyond_horizon() ? machine_epsilon : reference.certified.position;
}

Known known(double error, double certified) {
  return {std::max(error - certified, 0.0), error + certified};
}

bool is_uncertain(double error, double certified) { return certified > 0.1 * error; }

const char* judged_by(const Reference& reference) {
  return reference.is_beyond_horizon() ? "energy" : "position";
}

}  // namespace qddot::inline measure
