#include "qddot/measure/advice/ended_vibration.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "qddot/algebra/multipliers.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/rules.hpp"
#include "qddot/measure/advice/trial.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::inline measure {
namespace {

// Lays a state onto the rods of its system; false if that fails.
bool lay(const System& system, State& state) {
  Index first = 0;
  const auto lay_block = [&](const System& block) {
    const Index n = block.size();
    Vec q = state.q.segment(first, n), v = state.v.segment(first, n);
    if (block.constraints()) {
      Multipliers multipliers(block);
      At at(state.t, q, v);
      multipliers.take_gradients(at);
      if (!multipliers.factorize() || !multipliers.project(at, q, v)) return false;
      state.q.segment(first, n) = q;
      state.v.segment(first, n) = v;
    }
    first += n;
    return true;
  };
  if (system.blocks().empty()) return lay_block(system);
  return std::ranges::all_of(system.blocks(), [&](const auto& block) { return lay_block(*block); });
}

}  // namespace

std::optional<Scene> laid_on_rods(const Scene& scene, const Reductions& reductions) {
  const Model model(scene, reductions);
  State state = model.initial();
  if (!is_constrained(model.system()) || !lay(model.system(), state)) return {};
  const std::vector<Node> nodes = model.expand(state);
  Scene laid = scene;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].pinned) continue;
    laid.nodes[i].position = nodes[i].position;
    laid.nodes[i].velocity = nodes[i].velocity;
  }
  return laid;
}

std::optional<double> change_by_vibration(const VibrationCheck& check, double seconds) {
  constexpr Rules rules;
  const auto begin = clock_now();
  Alarm alarm;
  const auto runs_to = [&](Integrator& integrator, State& state, double until) {
    const Deadline deadline(std::max(0.0, seconds - seconds_since(begin)), alarm);
    return integrator.advance(state, until, {}, deadline.token()).outcome == Outcome::reached_end;
  };
  const auto distance = [&](const std::vector<Node>& a, const std::vector<Node>& b) {
    return position_error(a, b, check.scales);
  };
  const double rtol = std::max(least_accuracy, rules.small * rules.small * check.tolerance);
  const auto make = [&](const char* method, const Model& model) {
    const Method& chosen = *find_method(method);
    return make_integrator(chosen, model.system(), options_for(chosen, rtol, model));
  };
  const auto springs = make("arkode_erk8", check.springs),
             rods = make("arkode_erk8_rods", check.rods);
  const auto end_of = [&](State state) -> std::optional<std::vector<Node>> {
    if (!runs_to(*rods, state, check.until)) return {};
    return check.rods.expand(state);
  };
  const auto expected = end_of(check.rods.initial());
  if (!expected) return {};
  State state = check.springs.initial();
  std::vector<Node> last_end = *expected;
  double last_effect = 0;
  for (double t = check.first; t <= check.longest; t *= 2) {
    if (!runs_to(*springs, state, t)) return {};
    const std::vector<Node> nodes = check.springs.expand(state);
    State laid = check.rods.collect(nodes, t);
    if (!lay(check.rods.system(), laid)) return {};
    const double moved = distance(check.rods.expand(laid), nodes);
    const auto end = end_of(laid);
    if (!end) return {};
    // The vibration's effect since the last time. It goes on as before unless it is seen to fall.
    const double effect = distance(*end, last_end);
    const double later = effect <= last_effect / 2 ? effect : effect * check.until / t;
    const double change = moved + distance(*end, *expected) + rules.doubt * later;
    if (t > check.first && change <= check.tolerance) return change;
    // The effect up to the first time has the start in it, and is no measure of what goes on.
    last_effect = t > check.first ? effect : 0;
    last_end = *end;
  }
  return {};
}

}  // namespace qddot::inline measure
