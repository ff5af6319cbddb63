#include "qddot/measure/speed/judgement.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot::inline measure {
namespace {

double measured(const Point& point, Quantity quantity) {
  if (point.outcome != Outcome::reached_end) return std::numeric_limits<double>::quiet_NaN();
  const double errors[] = {point.errors.position, point.path.energy, point.path.momentum,
                           point.path.modal_shares};
  return errors[static_cast<int>(quantity)];
}

}  // namespace

const std::vector<double>& usual_accuracies() {
  static const std::vector<double> all = [] {
    std::vector<double> powers;
    for (int digit = 1; digit <= 9; ++digit) powers.push_back(std::pow(10.0, -digit));
    return powers;
  }();
  return all;
}

const char* name(Quantity quantity) {
  constexpr const char* names[] = {"position", "energy", "momentum", "modes"};
  return names[static_cast<int>(quantity)];
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

std::optional<double> largest_difference_by_chance(const Reference& reference) {
  const double floor = reference.modal_shares_floor;
  if (10 * floor < 1) return 10 * floor;
  // A share for each mode and one for all higher modes; a kept reference may be without them.
  const Index shares = reference.modal_shares.size();
  const bool has_three_modes = shares == 0 || shares > 3;
  return has_three_modes && 4 * floor < 1 ? std::optional(4 * floor) : std::nullopt;
}

Judged judged(const Point& point, const Reference& reference, Quantity quantity) {
  Judged judged{.error = measured(point, quantity)};
  const double bound = certified(reference, quantity);
  judged.bounds = known(judged.error, bound);
  judged.is_uncertain = bound > 0.1 * judged.error;
  judged.counts_at = judged.bounds.at_most;
  if (quantity != Quantity::energy || !reference.is_beyond_horizon()) return judged;
  const auto allowed = largest_difference_by_chance(reference);
  judged.may_count = !(point.path.modal_shares > allowed.value_or(1));
  judged.counts = judged.may_count && allowed;
  return judged;
}

Judged judged(const Point& point, const Reference& reference) {
  return judged(point, reference, judge_of(reference));
}

}  // namespace qddot::inline measure
