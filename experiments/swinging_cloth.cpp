#include "experiments/swinging_cloth.hpp"

#include <algorithm>
#include <stdexcept>

#include "experiments/interruption.hpp"
#include "integrators/registry.hpp"
#include "src/analysis/frequency_bound.hpp"
#include "src/scene/generators.hpp"

namespace qddot {
namespace {

Scene draw(int nodes, double stiffness) {
  return generate(*find_generator("cloth"),
                  {{"nodes", nodes},
                   {"mass", 1},
                   {"structural_stiffness", stiffness},
                   {"shear_stiffness", stiffness / 2},
                   {"bending_stiffness", stiffness / 10}},
                  "--nodes");
}

// The motion over `duration` by a quarter of the longest stable step of Verlet's.
State moved(const char* method, const System& system, State state, double duration) {
  const double h = 0.5 / frequency_bound(system, state.q);
  const Summary summary = make_integrator(*find_method(method), system, {.step_size = h})
                              ->advance(state, state.t + duration, {}, interruption());
  stop_if_interrupted();
  if (summary.outcome != Outcome::reached_end) throw std::runtime_error(summary.message);
  return state;
}

}  // namespace

SwingingCloth::SwingingCloth(int nodes, double stiffness, double swing)
    : drawn(draw(nodes, stiffness)),
      scene(drawn, Reductions().without(Reduction::mirror)),
      start(swing > 0 ? moved("verlet", system(), scene.initial(), swing) : scene.initial()) {}

State SwingingCloth::truth(const State& state, double duration) const {
  return moved("kahan_li8", system(), state, duration);
}

double SwingingCloth::distance(const State& a, const State& b) const {
  const auto x = scene.expand(a), y = scene.expand(b);
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    largest = std::max(largest, (x[i].position - y[i].position).norm());
  }
  return largest;
}

}  // namespace qddot
