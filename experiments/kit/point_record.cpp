#include "experiments/kit/point_record.hpp"

#include <fmt/format.h>

#include "experiments/kit/progress.hpp"
#include "qddot/integrators/registry.hpp"

// nlohmann::json looks for these functions in the namespace of the types.
namespace qddot::inline measure {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Errors, position, velocity, energy)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PathErrors, energy, momentum, modal_shares)

}  // namespace qddot::inline measure

namespace qddot::inline kit {

nlohmann::json record_of(const Point& p) {
  return {{"method", p.method->name},
          {"value", p.value},
          {"outcome", static_cast<int>(p.outcome)},
          {"t_reached", p.t_reached},
          {"errors", p.errors},
          {"path", p.path},
          {"time", p.time},
          {"time_min", p.time_min},
          {"setup", p.setup},
          {"timed_runs", p.timed_runs},
          {"counts", p.counts},
          {"energy_growth", p.energy_growth}};
}

Point point_of(const nlohmann::json& record) {
  return {.method = find_method(record.at("method").get<std::string>()),
          .value = record.at("value"),
          .outcome = static_cast<Outcome>(record.at("outcome").get<int>()),
          .t_reached = record.at("t_reached"),
          .errors = record.at("errors"),
          .path = record.at("path"),
          .time = record.at("time"),
          .time_min = record.at("time_min"),
          .setup = record.at("setup"),
          .timed_runs = record.at("timed_runs"),
          .counts = record.at("counts"),
          .energy_growth = record.at("energy_growth")};
}

std::function<Point(const Method&, double, const Effort::Take&)> points_of(Study& study,
                                                                           std::string prefix,
                                                                           std::string shown) {
  return [&study, prefix = std::move(prefix), shown = std::move(shown)](
             const Method& method, double value, const Effort::Take& take) {
    progress().now_at(fmt::format("{}{} {} = {:.3g}", shown, method.name,
                                  method.knob == Knob::step_size ? "h" : "rtol", value));
    const std::string name = fmt::format("{}{} {:.17g}", prefix, method.name, value);
    return point_of(study.piece(name, [&] { return record_of(take()); }));
  };
}

}  // namespace qddot::inline kit
