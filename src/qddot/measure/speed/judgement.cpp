#include "qddot/measure/speed/judgement.hpp"

#include <algorithm>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

double measured(const Point& point, Quantity quantity) {
  if (point.outcome != Outcome::reached_end) return std::numeric_limits<double>::quiet_NaN();
  switch (quantity) {
    case Quantity::position:
      return point.errors.position;
    case Quantity::energy:
      return point.path.energy;
    case Quantity::momentum:
      return point.path.momentum;
    case Quantity::modes:
      return point.path.modal_shares;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

const char* name(Quantity quantity) {
  switch (quantity) {
    case Quantity::position:
      return "position";
    case Quantity::energy:
      return "energy";
    case Quantity::momentum:
      return "momentum";
    case Quantity::modes:
      return "modes";
  }
  return "";
}

Known known(double error, double certified) {
  return {std::max(error - certified, 0.0), error + certified};
}

Quantity judge_of(const Reference& reference) {
  return reference.is_beyond_horizon() ? Quantity::energy : Quantity::position;
}

double certified(const Reference& reference, Quantity quantity) {
  if (quantity == Quantity::position) return reference.certified.position;
  // E(0) is known exactly; what rounding makes of E at later times is the run's own.
  return quantity == Quantity::energy ? machine_epsilon : 0;
}

double certified(const Reference& reference) { return certified(reference, judge_of(reference)); }

bool can_shares_tell(const Reference& reference) {
  return most_of_chance * reference.modal_shares_floor < 1;
}

Judged judged(const Point& point, const Reference& reference, Quantity quantity) {
  Judged judged{.error = measured(point, quantity)};
  const double bound = certified(reference, quantity);
  judged.bounds = known(judged.error, bound);
  judged.is_uncertain = bound > 0.1 * judged.error;
  if (quantity != Quantity::energy || !reference.is_beyond_horizon()) return judged;
  const bool is_another = point.path.modal_shares > most_of_chance * reference.modal_shares_floor;
  judged.may_count = !is_another;
  judged.counts = !is_another && can_shares_tell(reference);
  return judged;
}

Judged judged(const Point& point, const Reference& reference) {
  return judged(point, reference, judge_of(reference));
}

}  // namespace qddot::inline measure
