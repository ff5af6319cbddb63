#include "experiments/command/point_table.hpp"

#include <limits>

#include "qddot/measure/speed/judgement.hpp"

namespace qddot::command {

using namespace measure;

const std::vector<std::string>& point_columns() {
  static const std::vector<std::string> columns = {"scene",
                                                   "method",
                                                   "knob",
                                                   "value",
                                                   "outcome",
                                                   "t_reached",
                                                   "error_position",
                                                   "error_velocity",
                                                   "error_energy",
                                                   "time_s",
                                                   "time_min_s",
                                                   "setup_s",
                                                   "steps",
                                                   "rejected",
                                                   "force_evaluations",
                                                   "stiffness_evaluations",
                                                   "factorizations",
                                                   "solves",
                                                   "newton_iterations",
                                                   "indefinite_factorizations",
                                                   "order_mean",
                                                   "order_reductions",
                                                   "stability_limited_steps",
                                                   "timed_runs",
                                                   "family",
                                                   "order",
                                                   "error_energy_max",
                                                   "error_momentum_max",
                                                   "error_modal_shares",
                                                   "error_position_at_least",
                                                   "error_position_at_most",
                                                   "energy_growth"};
  return columns;
}

void point_row(Csv& csv, const std::string& scene, const Point& p, double certified) {
  const auto measured = [&](double x) {
    return p.outcome == Outcome::reached_end ? x : std::numeric_limits<double>::quiet_NaN();
  };
  const Known position = known(p.errors.position, certified);
  const Counts& c = p.counts;
  csv.row(scene, p.method->name, knob_name(p.method->knob), p.value, name(p.outcome), p.t_reached,
          measured(p.errors.position), measured(p.errors.velocity), measured(p.errors.energy),
          measured(p.time), measured(p.time_min), measured(p.setup), c.steps, c.rejected,
          c.force_evaluations, c.stiffness_evaluations, c.factorizations, c.solves,
          c.newton_iterations, c.indefinite_factorizations, order_mean(c), c.order_reductions,
          c.stability_limited_steps, p.timed_runs, family_name(p.method->family), p.method->order,
          measured(p.path.energy), measured(p.path.momentum), measured(p.path.modal_shares),
          measured(position.at_least), measured(position.at_most), p.energy_growth);
}

}  // namespace qddot::command
