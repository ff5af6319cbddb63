#include "qddot/measure/speed/work_precision.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "qddot/integrators/misfit_words.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/speed/front_again.hpp"
#include "qddot/measure/speed/ladder_points.hpp"

namespace qddot::inline measure {
namespace {

// Throws std::invalid_argument if there is nothing to measure the methods on.
void require_measurable(const Model& model, const std::vector<const Method*>& methods) {
  const System& system = model.system();
  if (system.size() == 0 || system.has_massless()) {
    throw std::invalid_argument(
        "work_precision: the model has no unknowns, or some without mass; all need a mass above 0");
  }
  for (const Method* method : methods) {
    if (const auto why = misfit(*method, system)) {
      throw std::invalid_argument(fmt::format("work_precision: {} cannot run this: {}",
                                              method->name, misfit_words(*method, *why)));
    }
  }
}

}  // namespace

WorkPrecision work_precision(const Model& model, Reference reference,
                             std::vector<const Method*> methods, const Effort& effort,
                             const std::function<void(const Point&)>& report) {
  require_measurable(model, methods);
  if (methods.empty()) {
    for (const Method& method : qddot::methods()) {
      if (applies_to(method, model.system())) methods.push_back(&method);
    }
  }
  WorkPrecision all{.reference = std::move(reference), .points = {}};
  for (const Method* method : methods) {
    const auto see = [&](const Point& point) {
      if (report) report(point);
    };
    const auto points =
        measure_ladder(*method, model, all.reference.end.t, all.reference, effort, see);
    all.points.insert(all.points.end(), points.begin(), points.end());
  }
  Effort timed_only = effort;
  timed_only.watch = nullptr;
  const auto again = [&](const Point& point) {
    return measure_point(*point.method, point.value, model, all.reference.end.t, all.reference,
                         timed_only);
  };
  take_smaller_times(all.points,
                     time_front_again(all.points, all.reference, usual_accuracies(), again));
  return all;
}

WorkPrecision work_precision(const Model& model, double until, std::vector<const Method*> methods,
                             const Effort& effort, double reference_seconds,
                             const std::function<void(const Point&)>& report) {
  require_measurable(model, methods);
  return work_precision(model, make_reference(model, until, reference_seconds), std::move(methods),
                        effort, report);
}

}  // namespace qddot::inline measure
