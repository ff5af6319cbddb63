#include "experiments/stability_map/chosen_steps.hpp"

#include <algorithm>
#include <cmath>

#include "qddot/integrators/registry.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot::stability_map {
namespace {

constexpr double duration = 10 * 2 * M_PI, fast_speed = 1e-6;

}  // namespace

ChosenSteps chosen_steps(const Method& method, double rtol, double omega) {
  Network network{.dimension = 1, .node_mass = Vec::Ones(2)};
  network.anchors = {{0, Eigen::Vector3d::Zero(), {.stiffness = 1}},
                     {1, Eigen::Vector3d::Zero(), {.stiffness = omega * omega}}};
  const auto system = make_mass_spring(network);
  State state{0, Vec{{1, 0}}, Vec{{0, fast_speed}}};
  const Summary summary =
      make_integrator(method, *system, {.rtol = rtol})->advance(state, duration);
  const Counts& c = summary.counts;
  const auto accepted = static_cast<double>(std::max<std::int64_t>(1, c.steps));
  const auto energy = [](double w, double q, double v) { return w * w * q * q + v * v; };
  return {.outcome = summary.outcome,
          .counts = c,
          .mean_h_omega = summary.t_reached / accepted * omega,
          .rejected = static_cast<double>(c.rejected) / static_cast<double>(c.steps + c.rejected),
          .fast_energy = energy(omega, state.q[1], state.v[1]),
          .energy_error = energy(1, state.q[0], state.v[0]) - 1};
}

}  // namespace qddot::stability_map
