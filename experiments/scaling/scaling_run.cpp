#include "experiments/scaling/scaling_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "experiments/kit/memory.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/machine_limits.hpp"
#include "qddot/model/kernels/spring_kernels.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/scene_limits.hpp"

namespace qddot::scaling {

// nlohmann::json looks for these in the namespace of the types.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PhaseCost, scene, nodes, springs, method, phase, seconds, bytes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ForceRate, seconds, bytes, flops)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ScalingSize, scene, hash, nodes, springs, unknowns, force, triad)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ScalingResults, sizes, methods, costs, left_out, has_failed)

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
// The largest memory while a scene is reduced, over the memory after that.
constexpr double passing_memory = 2.2;
// How long f and the triad are each looked at [s].
constexpr double look = 0.05;

const std::vector<std::string> phases_before = {"scene", "reduce"};
const std::vector<std::string> phases_of_method = {"symbolic",      "force", "stiffness",
                                                   "factorization", "solve", "preconditioner",
                                                   "iterations",    "rest"};

// The time [s] and memory [bytes] of making something.
struct Making {
  double seconds, bytes;
};

template <class T, class Make>
Making make(std::optional<T>& made, const Make& how) {
  const double before = allocated_memory();
  const double seconds = seconds_of([&] { made.emplace(how()); });
  return {seconds, allocated_memory() - before};
}

std::string at(const std::string& scene, double nodes) {
  return fmt::format("{}, {:g} nodes", scene, nodes);
}

double moving_springs(const Scene& scene) {
  return static_cast<double>(std::ranges::count_if(scene.springs, [&](const Spring& spring) {
    return !scene.nodes[spring.nodes[0]].pinned || !scene.nodes[spring.nodes[1]].pinned;
  }));
}

double bytes_of(const SymmetricMatrix& k) {
  return static_cast<double>(k.nonZeros() * (sizeof(double) + sizeof(int)) +
                             k.outerSize() * sizeof(int));
}

std::vector<Solver> select_solvers(const std::vector<std::string>& names) {
  std::vector<Solver> solvers;
  for (const std::string& name : names) {
    const auto solver = find_solver(name);
    if (!solver) {
      throw InvalidInput(
          fmt::format("--solvers: {} is not a solver; allowed are {}", name, solver_list()));
    }
    solvers.push_back(*solver);
  }
  return solvers;
}

template <class T>
void append(const std::vector<T>& more, std::vector<T>& all) {
  all.insert(all.end(), more.begin(), more.end());
}

// The times of a step of a method and of its phases [s], on the mean over a run.
struct StepPhases {
  Outcome outcome{};  // what follows means something only where it is reached_end
  std::string message;
  double total = 0;  // wall time
  Seconds parts;     // of it
  double rest() const {
    return total - parts.force - parts.stiffness - parts.factorization - parts.solve;
  }
};

// Eight springs are one job of a ring (see Rings); their laws and the weights are the same
// everywhere and stay in the cache. An unknown's q is read, its f is written, and its position goes
// to memory and back.
constexpr double bytes_of_spring = sizeof(kernels::RingJob) / double{kernels::slice_rows};
constexpr double bytes_of_unknown = 4 * sizeof(double);
// Operations of a job: d = x_j - x_i: 3; l^2 = d.d: 5; l: 1; s = l - l0: 1; tau = k s: 1; tau/l: 1.
// At each end: d: 3; f_i += (tau/l) d: 6.
constexpr double flops_of_spring = 12 + 2 * 9;

// The least time [s] of a timed run, unless that takes more than the most steps. Short runs are
// disturbed least.
constexpr double shortest_run = 5e-3;
constexpr double most_steps = 10000, least_steps = 3;
// The runs of which the least counts take this time together [s], or are this many.
constexpr double timed_together = 0.3;
constexpr int fewest_runs = 2;
// A first step of at least this time [s] counts as any other, and is the only one.
constexpr double own_warm_up = 5;

struct Run {
  Summary summary;
  double seconds;
};

Run run(Integrator& integrator, double step_size, double steps, const Model& scene) {
  State state = scene.initial();
  Run result;
  result.seconds =
      seconds_of([&] { result.summary = integrator.advance(state, steps * step_size); });
  return result;
}

// The cost of a step of the run, without the forces beyond `forces` a step.
StepPhases phases_of(const Run& run, double forces) {
  const double steps = static_cast<double>(run.summary.counts.steps);
  const double all = static_cast<double>(run.summary.counts.force_evaluations);
  const auto& [force, stiffness, factorization, solve] = run.summary.seconds;
  const double before = all > 0 ? force * (1 - forces * steps / all) : 0;
  return {run.summary.outcome,
          run.summary.message,
          (run.seconds - before) / steps,
          {(force - before) / steps, stiffness / steps, factorization / steps, solve / steps}};
}

// The fastest of evaluations of `seconds` at the scene's start. `springs`: how many of them move.
ForceRate force_rate(const Model& scene, double springs, double seconds) {
  const System& system = scene.system();
  const Vec& q = scene.initial().q;
  Vec f(system.size());
  return {
      .seconds = least_seconds(seconds, [&] { system.force(q, f); }),
      .bytes = bytes_of_spring * springs + bytes_of_unknown * static_cast<double>(system.size()),
      .flops = flops_of_spring * springs};
}

// Measures the cost of a step of `step_size` [s] from the scene's start. After one step to warm up,
// it repeats runs long enough for the clock; the fastest counts. A first step of some seconds is
// not repeated. Forces before the first step are subtracted.
StepPhases step_phases(Integrator& integrator, double step_size, const Model& scene) {
  const Run first = run(integrator, step_size, 1, scene);
  const auto forces = [](const Run& r) {
    return static_cast<double>(r.summary.counts.force_evaluations);
  };
  if (first.summary.outcome != Outcome::reached_end || first.seconds >= own_warm_up) {
    return phases_of(first, forces(first));
  }
  const double steps = std::clamp(std::ceil(shortest_run / first.seconds), least_steps, most_steps);
  Run least;
  double spent = 0;
  for (int i = 0; i < fewest_runs || spent < timed_together; ++i) {
    Run next = run(integrator, step_size, steps, scene);
    if (next.summary.outcome != Outcome::reached_end) return phases_of(next, 0);
    spent += next.seconds;
    if (i == 0 || next.seconds < least.seconds) least = std::move(next);
  }
  return phases_of(least, (forces(least) - forces(first)) / (steps - 1));
}

}  // namespace

std::vector<SolvedMethod> solved_methods(const SizedScenes& scenes, const Reductions& reductions,
                                         const std::vector<std::string>& methods,
                                         const std::vector<std::string>& solvers) {
  const Model smallest(scenes.draw(least_nodes), reductions);
  const auto all_solvers = select_solvers(solvers);
  std::vector<SolvedMethod> selected;
  for (const Method* method : select_methods(methods, smallest, scenes.name)) {
    if (method->knob != Knob::step_size) {
      throw InvalidInput(fmt::format(
          "--methods: {} chooses its steps by itself; allowed are methods of fixed step",
          method->name));
    }
    if (!method->listens_to(Option::solver)) {
      selected.push_back({method, Solver::multifrontal});
      continue;
    }
    for (const Solver solver : all_solvers) selected.push_back({method, solver});
  }
  return selected;
}

void ScalingRun::measure(Study& study, const SizedScenes& scenes, const std::vector<double>& sizes,
                         std::vector<SolvedMethod> methods) {
  progress().begin(sizes.size());
  for (const double size : sizes) {
    if (methods.empty()) return;
    const ScalingResults result = study.piece(fmt::format("{} {:.17g}", scenes.name, size), [&] {
      return nlohmann::json(measured_size(scenes, size, methods));
    });
    append(result.costs, all_.costs);
    append(result.sizes, all_.sizes);
    append(result.left_out, all_.left_out);
    all_.has_failed |= result.has_failed;
    progress().finish(at(scenes.name, std::round(size)));
    if (result.sizes.empty()) return;
    std::erase_if(methods, [&](const SolvedMethod& solved) {
      return std::ranges::find(result.methods, solved.name()) == result.methods.end();
    });
  }
}

ScalingResults ScalingRun::measured_size(const SizedScenes& scenes, double size,
                                         std::vector<SolvedMethod> methods) const {
  ScalingResults result;
  if (!fits(scenes, "", phases_before, size, passing_memory, result)) return result;
  progress().now_at(at(scenes.name, std::round(size)));
  std::optional<Scene> drawn;
  std::optional<Model> reduced;
  const Making drawing = make(drawn, [&] { return scenes.draw(size); });
  const double nodes = static_cast<double>(drawn->nodes.size());
  result.sizes.push_back({.scene = scenes.name,
                          .hash = content_hash(*drawn),
                          .nodes = nodes,
                          .springs = static_cast<double>(drawn->springs.size())});
  result.add("", "scene", drawing.seconds, drawing.bytes);
  const Making reducing = make(reduced, [&] {
    Model model(*drawn, limits_.reductions);
    model.system().stiffness_pattern();  // which all that is measured here asks for
    return model;
  });
  result.add("", "reduce", reducing.seconds, reducing.bytes);
  const double moving = moving_springs(*drawn);
  drawn.reset();
  ScalingSize& now = result.sizes.back();
  now.unknowns = reduced->system().size();
  now.force = force_rate(*reduced, moving, look);
  now.triad = triad_bandwidth(now.force.bytes, look);
  double stable = 0;  // half of what is certainly stable [s]; zero until an explicit method asks
  for (const SolvedMethod& solved : methods) {
    stop_if_interrupted();
    if (!fits(scenes, solved.name(), phases_of_method, nodes, 1, result)) continue;
    const bool implicit = solved.method->is(Trait::implicit);
    if (!implicit && stable == 0)
      stable = 1 / frequency_bound(reduced->system(), reduced->initial().q);
    progress().now_at(at(fmt::format("{}, {}", scenes.name, solved.name()), nodes));
    try {
      measure_method(solved, *reduced, implicit ? limits_.step_size : stable, result);
      result.methods.push_back(solved.name());
    } catch (const Interrupted&) {
      throw;
    } catch (const std::exception& error) {  // out of memory
      result.leave_out(solved.name(), error.what());
    }
  }
  return result;
}

void ScalingRun::measure_method(const SolvedMethod& solved, const Model& scene, double step_size,
                                ScalingResults& result) const {
  const Method& method = *solved.method;
  const std::string name = solved.name();
  const System& system = scene.system();
  double stiffness_bytes = nothing, factor_bytes = nothing;
  if (method.is(Trait::implicit) && method.asks(Need::stiffness)) {
    std::optional<EffectiveMass> matrix;
    const Making analysis = make(matrix, [&] { return EffectiveMass(system, solved.solver); });
    result.add(name, "symbolic", analysis.seconds, analysis.bytes);
    stiffness_bytes = bytes_of(system.stiffness_pattern());
    factor_bytes = static_cast<double>(matrix->bytes());
  }
  std::optional<std::unique_ptr<Integrator>> integrator;
  const Making all = make(integrator, [&] {
    return make_integrator(method, system,
                           {.step_size = step_size, .timed = true, .solver = solved.solver});
  });
  const StepPhases cost = step_phases(**integrator, step_size, scene);
  if (cost.outcome != Outcome::reached_end) {
    result.has_failed = true;
    result.leave_out(name, fmt::format("{}: {}", qddot::name(cost.outcome), cost.message));
    return;
  }
  const auto& [force, stiffness, factorization, solve] = cost.parts;
  result.add(name, "force", force, nothing);
  if (stiffness > 0) result.add(name, "stiffness", stiffness, stiffness_bytes);
  const bool iterates = solved.solver == Solver::conjugate_gradients;
  const char* making = iterates ? "preconditioner" : "factorization";
  if (factorization > 0) result.add(name, making, factorization, factor_bytes);
  if (solve > 0) result.add(name, iterates ? "iterations" : "solve", solve, nothing);
  result.add(name, "rest", cost.rest(), nothing);
  result.add(name, "step", cost.total, all.bytes);
}

// Whether these phases of a method, or those before any, may be expected to stay within the limits;
// leaves out what does not. `memory`: how many times what they will hold is held at once.
bool ScalingRun::fits(const SizedScenes& scenes, const std::string& method,
                      const std::vector<std::string>& phases, double nodes, double memory,
                      ScalingResults& result) const {
  double seconds = 0, bytes = 0;
  for (const std::string& phase : phases)
    seconds += expected_seconds(all_.costs, scenes, method, phase, nodes);
  // A step's bytes are all that its method allocates.
  for (const std::string& phase : method.empty() ? phases : std::vector<std::string>{"step"})
    bytes += expected_bytes(all_.costs, scenes, method, phase, nodes);
  bytes *= memory;
  if (method.empty() && bytes == 0) {  // the first size: nothing is measured yet
    const auto count = [](double x) { return static_cast<std::size_t>(x); };
    bytes = memory_of({count(nodes), count(scenes.springs_a_node * nodes)});
  }
  bytes += allocated_memory();
  const auto refuse = [&](const std::string& why) {
    result.left_out.push_back({scenes.name, method, nodes, why});
    return false;
  };
  if (seconds > limits_.seconds) {
    return refuse(
        fmt::format("it would take about {:.3g} s, more than {:g} s", seconds, limits_.seconds));
  }
  if (bytes > limits_.bytes) {
    return refuse(fmt::format("it would take about {:.3g} GB, more than {:.3g} GB", 1e-9 * bytes,
                              1e-9 * limits_.bytes));
  }
  return true;
}

}  // namespace qddot::scaling
