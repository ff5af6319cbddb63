#include <limits>

#include <fmt/format.h>

#include "experiments/record/chart_record.hpp"
#include "python/extension/bindings.hpp"
#include "python/extension/outside.hpp"
#include "qddot/measure/advice/advise.hpp"
#include "qddot/measure/advice/solve.hpp"
#include "qddot/measure/exchange/energy_exchange.hpp"
#include "qddot/measure/exchange/excitation.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/reference/reference_path.hpp"
#include "qddot/measure/speed/work_precision.hpp"
#include "qddot/measure/trend/drift_run.hpp"

namespace qddot::python {
namespace {
using py::arg;

// Makes something outside Python in about so many seconds. If that is too little, the sentence
// names Python's argument of them.
template <class Make>
auto made_in(double seconds, const std::string& argument, const Make& make) {
  try {
    return made_outside(make);
  } catch (const NoReference& error) {
    if (!error.needs_time()) throw;
    throw NoReference(
        fmt::format("{}, or for more time ({} = {:g})", error.what(), argument, seconds));
  }
}

HeldReference reference_of(const HeldModel& held, double until, double seconds,
                           const std::string& argument) {
  return {held, made_in(seconds, argument, [&] {
            return make_reference(*held.model, until, seconds, held.start.get());
          })};
}

// The numbers of a reference that pictures and readers need.
py::dict reference_record(const HeldReference& held) {
  const Reference& r = held.reference;
  py::list parts;
  for (const PartScale& part : r.scales.parts) {
    parts.append(
        py::dict(arg("displacement") = part.displacement, arg("at_rest") = part.is_at_rest()));
  }
  py::dict record(
      arg("until") = r.end.t, arg("energy") = r.energy, arg("certified") = record_of(r.certified),
      arg("rounding_effect") = r.rounding_effect, arg("chaotic") = r.is_chaotic(),
      arg("horizon") = r.horizon, arg("lyapunov") = r.lyapunov,
      arg("beyond_horizon") = r.is_beyond_horizon(), arg("only_symmetric") = r.is_only_symmetric(),
      arg("modal_shares_floor") = r.modal_shares_floor, arg("made_by") = r.made_by,
      arg("seconds") = r.seconds, arg("displacement") = r.scales.displacement, arg("parts") = parts,
      arg("divided_by") = what_divides(r));
  if (r.out_of_symmetry) record["symmetric_until"] = r.out_of_symmetry->horizon;
  return record;
}

py::dict end_of(const HeldReference& held) {
  const auto nodes = held.of.model->expand(held.reference.end);
  const int d = held.of.model->dimension();
  return py::dict(arg("q") = array_of(nodes, &Node::position, d),
                  arg("v") = array_of(nodes, &Node::velocity, d));
}

// Errors of positions and velocities of all nodes, q and v, against the state `at` of the
// reference.
std::pair<double, double> errors_at(const HeldReference& held, const State& at, const double* q,
                                    const double* v) {
  const auto exact = held.of.model->expand(at);
  const int d = held.of.model->dimension();
  std::vector<Node> nodes = exact;
  for (Node& node : nodes) {
    for (int c = 0; c < d; ++c) {
      node.position[c] = *q++;
      node.velocity[c] = *v++;
    }
  }
  const Scales& scales = held.reference.scales;
  return {position_error(nodes, exact, scales), velocity_error(nodes, exact, scales)};
}

// Those at the reference's end, for any method's result.
std::pair<double, double> errors_of(const HeldReference& held, const Doubles& q, const Doubles& v) {
  return errors_at(held, held.reference.end, q.data(), v.data());
}

// Those at each of the times (times, nodes, dimension), and the bounds of the reference's own
// errors of positions.
py::tuple errors_along(const HeldReference& held, const std::vector<double>& times,
                       const Doubles& q, const Doubles& v, double seconds) {
  const ReferencePath path = made_in(
      seconds, "seconds", [&] { return path_of(*held.of.model, held.reference, times, seconds); });
  std::vector<double> positions, velocities;
  const py::ssize_t frame = times.empty() ? 0 : q.size() / std::ssize(times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const py::ssize_t first = static_cast<py::ssize_t>(k) * frame;
    const auto [position, velocity] =
        errors_at(held, path.states[k], q.data() + first, v.data() + first);
    positions.push_back(position);
    velocities.push_back(velocity);
  }
  return py::make_tuple(array_of(positions), array_of(velocities), array_of(path.certified));
}

std::vector<const Method*> methods_named(const Names& names) {
  std::vector<const Method*> chosen;
  for (const std::string& name : names) chosen.push_back(&method(name));
  return chosen;
}

// A point's record with the bounds of its position error.
py::dict record_with_bounds(const Point& point, const Reference& reference) {
  py::dict record = record_of(point);
  const Known position = judged(point, reference, Quantity::position).bounds;
  record["error_position_at_least"] = position.at_least;
  record["error_position_at_most"] = position.at_most;
  return record;
}

// The points of all methods, and what the chart says of them as JSON (see chart_record.hpp).
// `report`: None, or a callable that is called with each point.
py::dict work_precision_of(const HeldReference& held, const Names& names, double seconds,
                           int repeats, const py::object& report) {
  Effort effort{.seconds = seconds, .repeats = repeats};
  const auto see = [&](const Point& point) {
    if (report.is_none()) return stop_if_interrupted();
    try {
      const py::gil_scoped_acquire acquired;
      report(record_with_bounds(point, held.reference));
    } catch (...) {
      remember(std::current_exception());
      throw;
    }
    stop_if_interrupted();
  };
  WorkPrecision measured;
  std::string chart;
  outside(1, [&](const std::stop_token&) {
    std::optional<Watch> watch;
    if (held.of.start) {  // only springs have momenta
      watch.emplace(*held.of.start, *held.of.model, held.reference.end.t, held.reference);
      effort.watch = &*watch;
    }
    measured = work_precision(*held.of.model, held.reference, methods_named(names), effort, see);
    chart = record::chart_record(measured.chart(*held.of.model), "null");
  });
  py::list points;
  for (const Point& point : measured.points)
    points.append(record_with_bounds(point, held.reference));
  return py::dict(arg("points") = points, arg("chart") = chart);
}

py::object candidate(const std::optional<Candidate>& c) {
  if (!c) return py::none();
  return py::dict(arg("method") = c->method->name, arg("knob") = knob_name(c->method->knob),
                  arg("value") = c->value, arg("error") = c->error, arg("seconds") = c->seconds);
}

py::dict advise_on(const HeldModel& held, double until, const std::vector<double>& accuracies,
                   const std::string& of) {
  const AccuracyOf what = accuracy_of(of);
  for (const double accuracy : accuracies) require_accuracy(accuracy, "accuracy");
  const Advices all =
      made_outside([&] { return advise(*held.model, until, accuracies, what, held.start.get()); });
  py::list each;
  for (const Advice& advice : all.for_each) {
    each.append(py::dict(arg("accuracy") = advice.accuracy, arg("why") = in_python(advice.why),
                         arg("margin") = advice.margin(), arg("take") = candidate(advice.take),
                         arg("runner_up") = candidate(advice.runner_up),
                         arg("own_explicit") = candidate(advice.own_explicit),
                         arg("own_implicit") = candidate(advice.own_implicit),
                         arg("sundials") = candidate(advice.sundials)));
  }
  return py::dict(arg("for_each") = each, arg("w_start") = all.w_start,
                  arg("w_motion") = all.w_motion, arg("own_frequency") = all.own_frequency,
                  arg("largest_stable_step") = all.largest_stable_step,
                  arg("lyapunov") = all.lyapunov, arg("horizon") = all.horizon,
                  arg("runs") = all.runs, arg("seconds") = all.seconds);
}

// The trend of the energy of a scene, or of a system of the caller's own, in a run of a method.
py::dict energy_trend_of(const HeldModel& held, const std::string& name, const py::dict& given,
                         double until, double seconds) {
  const Options options = options_of(given);
  const DriftRun run = made_outside([&] {
    DriftRun made =
        held.start ? energy_trend(*held.start, method(name), options, until, seconds)
                   : energy_trend(held.model, Momenta(), method(name), options, until, seconds);
    stop_if_interrupted();
    return made;
  });
  std::vector<double> t, energy, error;
  for (const DriftPoint& point : run.path) {
    t.push_back(point.t);
    energy.push_back(point.energy);
    error.push_back(point.error);
  }
  const Interval& drift = run.energy.drift;
  return py::dict(
      arg("outcome") = qddot::name(run.summary.outcome), arg("t_reached") = run.summary.t_reached,
      arg("seconds") = run.seconds, arg("t") = array_of(t), arg("energy") = array_of(energy),
      arg("error") = array_of(error),
      arg("drift") = py::make_tuple(drift.value, drift.low, drift.high),
      arg("oscillation") = run.energy.oscillation,
      arg("verdict") = verdict_name(verdict_at(run, until)), arg("words") = verdict(run, until));
}

py::array_t<double> energies_of(const EnergyCourse& course) {
  const auto times = static_cast<py::ssize_t>(course.times.size());
  const Index springs = course.energies.empty() ? 0 : course.energies.front().size();
  py::array_t<double> array({times, static_cast<py::ssize_t>(springs)});
  double* to = array.mutable_data();
  for (const Vec& energies : course.energies)
    to = std::copy(energies.data(), energies.data() + springs, to);
  return array;
}

// A run compared with the reference `exact`; `own` is the reference compared with itself.
py::dict run_record(const std::string& method, double h, double h_omega, const ExchangeRun& run,
                    const EnergyCourse& exact, const ExchangeComparison& own, double window) {
  py::dict record(arg("method") = method, arg("step_size") = h, arg("h_omega") = h_omega,
                  arg("outcome") = name(run.summary.outcome), arg("t") = array_of(run.course.times),
                  arg("energies") = energies_of(run.course),
                  arg("sum_deviation") = run.sum_deviation, arg("energy_error") = run.energy_error,
                  arg("exchange_error") = py::none(), arg("tempo") = py::none(),
                  arg("misfit") = py::none());
  if (run.summary.outcome != Outcome::reached_end) {
    record["verdict"] = verdict_on(run.summary);
    return record;
  }
  const ExchangeComparison c = compare(run.course, exact, window);
  record["exchange_error"] = c.distance;
  record["tempo"] = c.tempo;
  record["misfit"] = c.misfit;
  record["verdict"] = verdict_on(c, own);
  return record;
}

py::dict exchange(const HeldModel& held, const Names& names, const std::vector<double>& h_omegas,
                  double until, std::optional<double> every) {
  struct Made {
    const Method* method;
    double h_omega;
    ExchangeRun run;
  };
  std::optional<Excitation> excitation;
  CertifiedCourse reference;
  std::vector<Made> runs;
  for (const std::string& name : names) {
    if (method(name).knob != Knob::step_size)
      throw std::invalid_argument(name + " chooses its steps by itself, so that it has no h w");
  }
  outside(1, [&](const std::stop_token&) {
    excitation.emplace(excitation_of(*held.start, Model(*held.start), until, held.start->name));
    if (every) excitation->every = *every;
    reference = certified_course(*excitation);
    for (const std::string& name : names) {
      for (const double h_omega : h_omegas) {
        stop_if_interrupted();
        const double h = h_omega / excitation->omega;
        runs.push_back({&method(name), h_omega,
                        exchange_run(*excitation, method(name), h, looks(*excitation, h))});
      }
    }
    stop_if_interrupted();
  });
  const EnergyCourse& exact = reference.run.course;
  const ExchangeComparison own = compare(exact, exact, excitation->window);
  py::list records;
  for (const Made& made : runs) {
    records.append(run_record(made.method->name, made.h_omega / excitation->omega, made.h_omega,
                              made.run, exact, own, excitation->window));
  }
  return py::dict(arg("omega") = excitation->omega, arg("certified") = reference.certified,
                  arg("reference") = run_record("reference", reference.h, CertifiedCourse::h_omega,
                                                reference.run, exact, own, excitation->window),
                  arg("runs") = records);
}

}  // namespace

py::dict record_of(const Errors& errors) {
  return py::dict(arg("position") = errors.position, arg("velocity") = errors.velocity,
                  arg("energy") = errors.energy);
}

py::dict record_of(const Point& p) {
  const bool is = p.outcome == Outcome::reached_end;
  const auto measured = [is](double x) {
    return is ? x : std::numeric_limits<double>::quiet_NaN();
  };
  py::dict record(arg("method") = p.method->name, arg("knob") = knob_name(p.method->knob),
                  arg("value") = p.value, arg("outcome") = std::string(name(p.outcome)),
                  arg("t_reached") = p.t_reached,
                  arg("error_position") = measured(p.errors.position),
                  arg("error_velocity") = measured(p.errors.velocity),
                  arg("error_energy") = measured(p.errors.energy), arg("time_s") = measured(p.time),
                  arg("time_min_s") = measured(p.time_min), arg("setup_s") = measured(p.setup),
                  arg("order_mean") = order_mean(p.counts), arg("timed_runs") = p.timed_runs,
                  arg("family") = family_name(p.method->family), arg("order") = p.method->order,
                  arg("error_energy_max") = measured(p.path.energy),
                  arg("error_momentum_max") = measured(p.path.momentum),
                  arg("error_modal_shares") = measured(p.path.modal_shares),
                  arg("energy_growth") = p.energy_growth, arg("stock_of") = p.method->stock_of);
  record.attr("update")(record_of(p.counts));
  return record;
}

void add_measures(py::module_& module) {
  py::class_<HeldReference> reference(module, "Reference");
  reference.def("record", [](const HeldReference& held) { return reference_record(held); });
  reference.def("end", &end_of);
  reference.def("errors", &errors_of);
  reference.def("errors_along", &errors_along);
  module.def("reference", &reference_of);
  module.def("work_precision", &work_precision_of);
  module.def("advise", &advise_on);
  module.def("energy_trend", &energy_trend_of);
  module.def("exchange", &exchange);
}

}  // namespace qddot::python
