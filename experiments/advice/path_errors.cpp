#include "experiments/advice/path_errors.hpp"

#include <algorithm>
#include <cstdint>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/speed/measurement.hpp"

namespace qddot::judged_advice {
namespace {

// Slow methods do not come to the end at small tolerances.
constexpr std::int64_t most_forces_on_path = 30000;

void follow(const Method& method, double value, const JudgedMotion& motion, const System& system,
            State state, const Observer& observer) {
  Options options = options_for(method, value, motion.model());
  options.most_forces = most_forces_on_path;
  make_integrator(method, system, options)
      ->advance(state, motion.truth().times.back(), observer, interruption());
}

// Gives the states of a run of the block at those ends of its steps that are beside a look.
std::vector<State> steps_of(const Method& method, double value, const JudgedMotion& motion,
                            const System& block, const State& start) {
  const std::vector<double>& looks = motion.truth().times;
  std::vector<State> all{start}, steps;
  follow(method, value, motion, block, start,
         {{}, {}, [&](const State& state) { all.push_back(state); }});
  for (std::size_t i = 1; i < all.size(); ++i) {
    const double next = all[std::min(i + 1, all.size() - 1)].t;
    if (*std::ranges::lower_bound(looks, all[i - 1].t) <= next) steps.push_back(all[i]);
  }
  return steps;
}

// Raises the errors to those of the block whose unknowns begin at `first`.
void raise(std::vector<double>& errors, const Method& method, double value,
           const JudgedMotion& motion, const System& block, Index first) {
  const Model& model = motion.model();
  const State& start = model.initial();
  const Index n = block.size();
  const auto steps = steps_of(method, value, motion, block,
                              {0, start.q.segment(first, n), start.v.segment(first, n)});
  std::vector<double> times, largest{0};
  for (const State& state : steps) times.push_back(state.t);
  for (State& fine : motion.fine_path(times)) {
    const auto expected = model.expand(fine);
    fine.q.segment(first, n) = steps[largest.size() - 1].q;
    const double error = position_error(model.expand(fine), expected, motion.scales());
    largest.push_back(std::max(largest.back(), error - motion.fine_error()));
  }
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const auto place = std::ranges::lower_bound(times, motion.truth().times[i]) - times.begin();
    const auto ends = std::min(static_cast<std::size_t>(place) + 1, largest.size() - 1);
    errors[i] = std::max(errors[i], largest[ends]);
  }
}

}  // namespace

std::vector<double> errors_at_looks(const Method& method, double value,
                                    const JudgedMotion& motion) {
  const Model& model = motion.model();
  const TrueMotion& truth = motion.truth();
  std::vector<double> errors;
  const auto see = [&](const State& s) {
    errors.push_back(position_error(model.expand(s), truth.path[errors.size()], motion.scales()));
  };
  follow(method, value, motion, model.system(), model.initial(), {truth.times, see});
  return errors;
}

std::vector<double> errors_at_steps(const Method& method, double value,
                                    const JudgedMotion& motion) {
  const System& system = motion.model().system();
  std::vector<double> errors(motion.truth().times.size());
  if (system.blocks().empty()) raise(errors, method, value, motion, system, 0);
  Index first = 0;
  for (const auto& block : system.blocks()) {
    raise(errors, method, value, motion, *block, first);
    first += block->size();
  }
  return errors;
}

}  // namespace qddot::judged_advice
