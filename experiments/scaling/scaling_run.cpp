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
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/scene_limits.hpp"

namespace qddot::scaling {

// nlohmann::json looks for these in the namespace of the types.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PhaseCost, scene, nodes, springs, method, phase, seconds, bytes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ForceRate, seconds, bytes, flops)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ScalingSize, scene, hash, nodes, springs, unknowns, force, triad)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LeftOut, scene, method, nodes, why)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SizeResult, sizes, methods, costs, left_out, has_failed)

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

}  // namespace

std::vector<SolvedMethod> solved_methods(const SizedScenes& scenes, const Reductions& reductions,
                                         const std::vector<std::string>& methods,
                                         const std::vector<std::string>& solvers) {
  const ReducedScene smallest(scenes.draw(least_nodes), reductions);
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
    const SizeResult result = study.piece(fmt::format("{} {:.17g}", scenes.name, size), [&] {
      return nlohmann::json(measured_size(scenes, size, methods));
    });
    append(result.costs, costs_);
    append(result.sizes, sizes_);
    append(result.left_out, left_out_);
    has_failed_ = has_failed_ || result.has_failed;
    progress().finish(at(scenes.name, std::round(size)));
    if (result.sizes.empty()) return;
    std::erase_if(methods, [&](const SolvedMethod& solved) {
      return std::ranges::find(result.methods, solved.name()) == result.methods.end();
    });
  }
}

SizeResult ScalingRun::measured_size(const SizedScenes& scenes, double size,
                                     std::vector<SolvedMethod> methods) const {
  SizeResult result;
  if (!fits(scenes, "", phases_before, size, passing_memory, result)) return result;
  progress().now_at(at(scenes.name, std::round(size)));
  std::optional<Scene> drawn;
  std::optional<ReducedScene> reduced;
  const Making drawing = make(drawn, [&] { return scenes.draw(size); });
  const double nodes = static_cast<double>(drawn->nodes.size());
  result.sizes.push_back({.scene = scenes.name,
                          .hash = content_hash(*drawn),
                          .nodes = nodes,
                          .springs = static_cast<double>(drawn->springs.size())});
  result.add("", "scene", drawing.seconds, drawing.bytes);
  const Making reducing = make(reduced, [&] { return ReducedScene(*drawn, limits_.reductions); });
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

void ScalingRun::measure_method(const SolvedMethod& solved, const ReducedScene& scene,
                                double step_size, SizeResult& result) const {
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
                      SizeResult& result) const {
  double seconds = 0, bytes = 0;
  for (const std::string& phase : phases) {
    seconds += expected_seconds(costs_, scenes, method, phase, nodes);
    if (method.empty()) bytes += expected_bytes(costs_, scenes, method, phase, nodes);
  }
  if (!method.empty()) bytes = expected_bytes(costs_, scenes, method, "step", nodes);
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
