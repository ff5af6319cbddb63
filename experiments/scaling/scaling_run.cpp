#include "experiments/scaling/scaling_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "experiments/kit/memory.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/scaling/step_cost.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/analysis/frequency_bound.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/machine_limits.hpp"
#include "qddot/scene/scene_limits.hpp"

namespace qddot::scaling {

// What nlohmann::json looks for by these names.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PhaseCost, scene, nodes, springs, method, phase, seconds, bytes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ForceRate, seconds, bytes, flops)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ScalingSize, scene, hash, nodes, springs, unknowns, force, triad)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LeftOut, scene, method, nodes, why)

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
// What is held while a scene is reduced, at most, over what is left of it then.
constexpr double passing_memory = 2.2;
// How long f and the triad are each looked at [s].
constexpr double look = 0.05;

const std::vector<std::string> phases_before = {"scene", "reduce"};
const std::vector<std::string> phases_of_method = {"symbolic",      "force", "stiffness",
                                                   "factorization", "solve", "preconditioner",
                                                   "iterations",    "rest"};

// What making something takes.
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

std::vector<std::string> names_of(const std::vector<SolvedMethod>& methods) {
  std::vector<std::string> names;
  for (const SolvedMethod& solved : methods) names.push_back(solved.name());
  return names;
}

// What was added to the first `count`.
template <class T>
std::vector<T> since(const std::vector<T>& all, std::size_t count) {
  return {all.begin() + static_cast<std::ptrdiff_t>(count), all.end()};
}

template <class T>
void append(const nlohmann::json& more, std::vector<T>& all) {
  for (const auto& one : more) all.push_back(one.get<T>());
}

}  // namespace

std::string SolvedMethod::name() const {
  if (solver == Solver::multifrontal) return method->name;
  const auto found = std::ranges::find(solver_names, solver, [](const auto& n) { return n.first; });
  return fmt::format("{}:{}", method->name, found->second);
}

void ScalingRun::measure(Study& study, const SizedScenes& scenes, const std::vector<double>& sizes,
                         std::vector<SolvedMethod> methods) {
  progress().begin(sizes.size());
  for (const double size : sizes) {
    if (methods.empty()) return;
    const nlohmann::json piece =
        study.piece(fmt::format("{} {:.17g}", scenes.name, size), [&]() -> nlohmann::json {
          ScalingRun one = *this;
          auto fitting = methods;
          const bool has_measured = one.measure_size(scenes, size, fitting);
          return {{"measured", has_measured},
                  {"methods", names_of(fitting)},
                  {"costs", since(one.costs_, costs_.size())},
                  {"sizes", since(one.sizes_, sizes_.size())},
                  {"left_out", since(one.left_out_, left_out_.size())},
                  {"has_failed", one.has_failed_}};
        });
    append(piece.at("costs"), costs_);
    append(piece.at("sizes"), sizes_);
    append(piece.at("left_out"), left_out_);
    has_failed_ = piece.at("has_failed");
    progress().finish(at(scenes.name, std::round(size)));
    if (!piece.at("measured")) return;
    const std::vector<std::string> fitting = piece.at("methods");
    std::erase_if(methods, [&](const SolvedMethod& solved) {
      return std::ranges::find(fitting, solved.name()) == fitting.end();
    });
  }
}

bool ScalingRun::measure_size(const SizedScenes& scenes, double size,
                              std::vector<SolvedMethod>& methods) {
  if (!fits(scenes, "", phases_before, size, passing_memory)) return false;
  progress().now_at(at(scenes.name, std::round(size)));
  std::optional<Scene> drawn;
  std::optional<ReducedScene> reduced;
  const Making drawing = make(drawn, [&] { return scenes.draw(size); });
  sizes_.push_back({.scene = scenes.name,
                    .hash = content_hash(*drawn),
                    .nodes = static_cast<double>(drawn->nodes.size()),
                    .springs = static_cast<double>(drawn->springs.size())});
  add("", "scene", drawing.seconds, drawing.bytes);
  const Making reducing = make(reduced, [&] { return ReducedScene(*drawn, limits_.reductions); });
  add("", "reduce", reducing.seconds, reducing.bytes);
  const double moving = moving_springs(*drawn);
  drawn.reset();
  sizes_.back().unknowns = reduced->system().size();
  sizes_.back().force = force_rate(*reduced, moving, look);
  sizes_.back().triad = triad_bandwidth(sizes_.back().force.bytes, look);
  measure_methods(scenes, *reduced, methods);
  return true;
}

void ScalingRun::measure_methods(const SizedScenes& scenes, const ReducedScene& scene,
                                 std::vector<SolvedMethod>& methods) {
  const double nodes = sizes_.back().nodes;
  double stable = 0;  // half of what is certainly stable [s]; zero until an explicit method asks
  std::erase_if(methods, [&](const SolvedMethod& solved) {
    stop_if_interrupted();
    if (!fits(scenes, solved.name(), phases_of_method, nodes, 1)) return true;
    const bool implicit = solved.method->is(Trait::implicit);
    if (!implicit && stable == 0) {
      stable = 1 / frequency_bound(scene.system(), scene.initial().q);
    }
    progress().now_at(at(fmt::format("{}, {}", scenes.name, solved.name()), nodes));
    try {
      measure_method(solved, scene, implicit ? limits_.step_size : stable);
    } catch (const Interrupted&) {
      throw;
    } catch (const std::exception& error) {  // out of memory
      leave_out(solved.name(), nodes, error.what());
      return true;
    }
    return false;
  });
}

void ScalingRun::measure_method(const SolvedMethod& solved, const ReducedScene& scene,
                                double step_size) {
  const Method& method = *solved.method;
  const std::string name = solved.name();
  const System& system = scene.system();
  double stiffness_bytes = nothing, factor_bytes = nothing;
  if (method.is(Trait::implicit) && method.asks(Need::stiffness)) {
    std::optional<EffectiveMass> matrix;
    const Making analysis = make(matrix, [&] { return EffectiveMass(system, solved.solver); });
    add(name, "symbolic", analysis.seconds, analysis.bytes);
    stiffness_bytes = bytes_of(system.stiffness_pattern());
    factor_bytes = static_cast<double>(matrix->bytes());
  }
  std::optional<std::unique_ptr<Integrator>> integrator;
  const Making all = make(integrator, [&] {
    return make_integrator(method, system,
                           {.step_size = step_size, .timed = true, .solver = solved.solver});
  });
  const StepCost cost = step_cost(**integrator, step_size, scene);
  if (cost.outcome != Outcome::reached_end) {
    has_failed_ = true;
    leave_out(name, sizes_.back().nodes,
              fmt::format("{}: {}", qddot::name(cost.outcome), cost.message));
    return;
  }
  const auto& [force, stiffness, factorization, solve] = cost.parts;
  add(name, "force", force, nothing);
  if (stiffness > 0) add(name, "stiffness", stiffness, stiffness_bytes);
  const bool iterates = solved.solver == Solver::conjugate_gradients;
  const char* making = iterates ? "preconditioner" : "factorization";
  if (factorization > 0) add(name, making, factorization, factor_bytes);
  if (solve > 0) add(name, iterates ? "iterations" : "solve", solve, nothing);
  add(name, "rest", cost.rest(), nothing);
  add(name, "step", cost.total, all.bytes);
}

// Whether these phases of a method, or those before any, may be expected to stay within the limits;
// leaves out what does not. `memory`: how many times what they will hold is held at once.
bool ScalingRun::fits(const SizedScenes& scenes, const std::string& method,
                      const std::vector<std::string>& phases, double nodes, double memory) {
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
    left_out_.push_back({scenes.name, method, nodes, why});
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

void ScalingRun::leave_out(const std::string& method, double nodes, std::string why) {
  left_out_.push_back({sizes_.back().scene, method, nodes, std::move(why)});
}

void ScalingRun::add(const std::string& method, const std::string& phase, double seconds,
                     double bytes) {
  const ScalingSize& size = sizes_.back();
  costs_.push_back({size.scene, size.nodes, size.springs, method, phase, seconds, bytes});
}

}  // namespace qddot::scaling
