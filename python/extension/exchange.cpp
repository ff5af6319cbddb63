#include "python/extension/bindings.hpp"
#include "python/extension/outside.hpp"
#include "qddot/measure/exchange/energy_exchange.hpp"
#include "qddot/measure/exchange/excitation.hpp"
#include "qddot/measure/motion/simulation.hpp"

namespace qddot::python {
namespace {
using py::arg;

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

py::dict exchange(const Model& model, const Names& names, const std::vector<double>& h_omegas,
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
    excitation.emplace(
        excitation_of(*model.start, ReducedScene(*model.start), until, model.start->name));
    if (every) excitation->every = *every;
    reference = certified_course(*excitation);
    for (const std::string& name : names) {
      for (const double h_omega : h_omegas) {
        stop_if_interrupted();
        const double h = h_omega / excitation->omega;
        runs.push_back({&method(name), h_omega,
                        exchange_run(*excitation, method(name), h,
                                     multiples_near(excitation->every, h, until))});
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

void add_exchange(py::module_& module) { module.def("exchange", &exchange); }

}  // namespace qddot::python
