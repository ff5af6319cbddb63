#include <limits>

#include "python/extension/bindings.hpp"
#include "python/extension/outside.hpp"
#include "qddot/algebra/constraint_forces.hpp"
#include "qddot/measure/advice/lesser_answer.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/simulation.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/stability/diagnosis.hpp"
#include "qddot/measure/stability/energy_loss.hpp"
#include "qddot/scene/rods.hpp"

namespace qddot::python {
namespace {
using py::arg;

// The tensions of rods [N] at some states, (states, springs of the scene): 0 for a rod in a part
// that rests in its fall, NaN for springs that are none. None without rods.
class Tensions {
 public:
  explicit Tensions(const HeldModel& held) : held_(held), forces_(held.model->system()) {
    if (!held.start) return;
    for (const Spring& spring : held.start->springs) {
      none_.push_back(spring.law.rigid ? 0 : std::numeric_limits<double>::quiet_NaN());
    }
    has_rods_ = has_rods(*held.start);
  }
  void see(const State& state) {
    if (!has_rods_) return;
    std::vector<double> row = none_;
    const Vec own = held_.model->tensions_by(forces_.at(state));
    const std::vector<std::size_t>& rods = held_.model->rods();
    for (std::size_t k = 0; k < rods.size(); ++k) row[rods[k]] = own[static_cast<Index>(k)];
    rows_.insert(rows_.end(), row.begin(), row.end());
  }
  py::object array() const {
    if (!has_rods_) return py::none();
    const std::size_t width = none_.size();
    py::array_t<double> all({rows_.size() / width, width});
    std::ranges::copy(rows_, all.mutable_data());
    return all;
  }

 private:
  const HeldModel& held_;
  ConstraintForces forces_;
  std::vector<double> none_, rows_;
  bool has_rods_ = false;
};

// That of one state.
py::object tensions_of(const HeldModel& held, const State& state) {
  Tensions tensions(held);
  tensions.see(state);
  return tensions.array();
}

// The caller's arrays that a run fills at the observed times: positions and velocities (2, times,
// nodes, dimension), energies (6, times).
class Frames {
 public:
  Frames(const HeldModel& held, std::vector<double> times, py::array_t<double>& motion,
         std::optional<py::array_t<double>>& energies)
      : model_(*held.model),
        tensions_(held),
        times_(std::move(times)),
        motion_(motion.mutable_data()),
        block_(static_cast<std::size_t>(motion.size()) / 2),
        frame_(times_.empty() ? 0 : block_ / times_.size()),
        energies_(energies ? energies->mutable_data() : nullptr) {}

  Observer observer() {
    if (times_.empty()) return {};
    return {times_, [this](const State& state) { see(state); }};
  }
  std::size_t seen() const { return seen_; }
  py::object tensions() const { return tensions_.array(); }

 private:
  void see(const State& state) {
    const auto nodes = model_.expand(state);
    tensions_.see(state);
    double* to = motion_ + seen_ * frame_;
    write(nodes, &Node::position, model_.dimension(), to);
    write(nodes, &Node::velocity, model_.dimension(), to + block_);
    if (energies_) {
      const double kinetic = model_.kinetic(state), potential = model_.potential(state);
      energies_[seen_] = kinetic;
      energies_[seen_ + times_.size()] = potential;
      energies_[seen_ + 2 * times_.size()] = kinetic + potential;
      energies_[seen_ + 3 * times_.size()] = model_.dissipated(state);
      energies_[seen_ + 4 * times_.size()] = model_.driven(state);
      energies_[seen_ + 5 * times_.size()] = model_.released(state);
    }
    ++seen_;
  }

  const Model& model_;
  Tensions tensions_;
  std::vector<double> times_;
  double* motion_;
  std::size_t block_, frame_;
  double* energies_;
  std::size_t seen_ = 0;
};

py::dict end_of(const Model& model, const State& state) {
  const auto nodes = model.expand(state);
  const int d = model.dimension();
  return py::dict(arg("t") = state.t, arg("q") = array_of(nodes, &Node::position, d),
                  arg("v") = array_of(nodes, &Node::velocity, d));
}

// The kinetic energy, the potential energy, their sum, what damping has taken, what driving has
// given and what springs held when they broke [J]; None for a system without V.
py::object energies_of(const Model& model, const State& state) {
  if (!model.system().has_potential()) return py::none();
  const double kinetic = model.kinetic(state);
  double potential = 0;
  inside_python([&] { potential = model.potential(state); });
  return py::make_tuple(kinetic, potential, kinetic + potential, model.dissipated(state),
                        model.driven(state), model.released(state));
}

// The springs that broke, by the scene's numbers; `errors` of their times [s] may be empty.
py::list breaks_of(const Model& model, const Summary& summary, const std::vector<double>& errors) {
  py::list all;
  for (std::size_t k = 0; k < summary.breaks.size(); ++k) {
    const Break& one = summary.breaks[k];
    const std::vector<std::size_t>& springs = model.general_springs();
    const auto number = static_cast<std::size_t>(one.number);
    all.append(py::make_tuple(one.t, number < springs.size() ? springs[number] : number, one.strain,
                              one.energy,
                              errors.empty() ? py::object(py::none()) : py::float_(errors[k])));
  }
  return all;
}

// A run of a method, which fills the arrays of Frames.
py::dict run(const HeldModel& held, const std::string& name, const py::dict& given, double until,
             const std::vector<double>& times, py::array_t<double> motion,
             std::optional<py::array_t<double>> energies, std::optional<double> most_seconds,
             int threads) {
  const Options options = options_of(given);
  std::optional<Simulation> simulation;
  Frames frames(held, times, motion, energies);
  Summary summary;
  double seconds = 0;
  outside(threads, [&](const std::stop_token& stop) {
    simulation.emplace(held.model, method(name), options);
    std::optional<Deadline> deadline;
    if (most_seconds) deadline.emplace(*most_seconds);
    seconds = seconds_of([&] {
      summary = simulation->advance(until, frames.observer(), deadline ? deadline->token() : stop);
    });
  });
  return py::dict(arg("summary") = record_of(summary), arg("seconds") = seconds,
                  arg("seen") = frames.seen(), arg("tensions") = frames.tensions(),
                  arg("end_tensions") = tensions_of(held, simulation->state()),
                  arg("end") = end_of(*held.model, simulation->state()),
                  arg("energies") = energies_of(*held.model, simulation->state()),
                  arg("breaks") = breaks_of(*held.model, summary, {}),
                  arg("growth") = in_python(growth_warning(method(name), summary)));
}

// The motion to an accuracy.
py::dict answer(HeldModel held, const std::vector<std::string>& kept, double until, double accuracy,
                const std::string& of, std::optional<double> most_seconds, int threads) {
  Wanted wanted{.accuracy = accuracy, .of = accuracy_of(of)};
  if (most_seconds) wanted.seconds = *most_seconds;
  const auto begin = clock_now();
  const Reductions reductions = reductions_without(kept);
  std::optional<LesserAnswer> lesser;
  Answer found;
  outside(threads, [&](const std::stop_token&) {
    if (held.start) lesser = solve_with_less(*held.start, reductions, until, wanted);
    if (most_seconds) wanted.seconds = std::max(0.0, *most_seconds - seconds_since(begin));
    found = lesser ? lesser->answer : solve(*held.model, until, wanted, held.start.get());
  });
  if (lesser) held = {lesser->model, std::make_shared<const Scene>(std::move(lesser->scene))};
  py::dict record(arg("is_reached") = found.is_reached, arg("why") = in_python(found.why),
                  arg("error_estimate") = found.error_estimate,
                  arg("error_estimate_kind") = name(found.error_estimate_kind),
                  arg("horizon") = found.horizon, arg("runs") = found.runs,
                  arg("seconds") = found.seconds.run, arg("seconds_in_all") = found.seconds.total(),
                  arg("summary") = record_of(found.summary), arg("left_out") = "");
  if (lesser) {
    record["left_out"] = lesser->in_words();
    record["model_of_answer"] = held;
  }
  if (!found.method) return record;
  record["method"] = found.method->name;
  record["value"] = found.value;
  record["looks"] = found.looks;
  record["end"] = end_of(*held.model, found.end);
  record["energies"] = energies_of(*held.model, found.end);
  record["end_tensions"] = tensions_of(held, found.end);
  record["breaks"] = breaks_of(*held.model, found.summary, found.break_errors);
  return record;
}

std::string why_it_failed(const HeldModel& held, const std::string& name, const py::dict& given,
                          double until, double seconds) {
  const Method& chosen = method(name);
  const Options options = options_of(given);
  std::string words;
  outside(1, [&](const std::stop_token& stop) {
    Simulation simulation(held.model, chosen, options);
    const Summary summary = simulation.advance(until, {}, stop);
    if (summary.outcome != Outcome::reached_end) {
      words = diagnosis(chosen, options, *held.model, until, summary, seconds);
      return;
    }
    words = step_warning(chosen, options, *held.model);
    if (words.empty()) {
      words = loss_warning(chosen, options, *held.model, summary, until, seconds);
    }
  });
  return in_python(words);
}

}  // namespace

measure::AccuracyOf accuracy_of(const std::string& of) {
  if (of == "positions") return AccuracyOf::positions;
  if (of == "path") return AccuracyOf::path;
  if (of == "energy") return AccuracyOf::energy;
  throw std::invalid_argument("accuracy_of: " + of + "; allowed are positions, path and energy");
}

py::dict record_of(const Counts& c) {
  return py::dict(arg("steps") = c.steps, arg("rejected") = c.rejected,
                  arg("force_evaluations") = c.force_evaluations,
                  arg("stiffness_evaluations") = c.stiffness_evaluations,
                  arg("factorizations") = c.factorizations, arg("solves") = c.solves,
                  arg("newton_iterations") = c.newton_iterations,
                  arg("indefinite_factorizations") = c.indefinite_factorizations,
                  arg("order_reductions") = c.order_reductions,
                  arg("stability_limited_steps") = c.stability_limited_steps);
}

py::dict record_of(const Summary& s) {
  return py::dict(arg("outcome") = std::string(name(s.outcome)), arg("t_reached") = s.t_reached,
                  arg("message") = in_python(s.message), arg("energy_growth") = s.energy_growth,
                  arg("energy_loss") = s.energy_loss, arg("counts") = record_of(s.counts));
}

void add_runs(py::module_& module) {
  module.def("run", &run);
  module.def("answer", &answer);
  module.def("why_it_failed", &why_it_failed);
}

}  // namespace qddot::python
