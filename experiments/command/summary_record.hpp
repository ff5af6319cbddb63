#pragma once

#include <nlohmann/json.hpp>

#include "qddot/integrators/integrator.hpp"

// What became of a run, as a journal keeps it, by the names of the members; Seconds are left out.
// In the namespace of these types, where nlohmann::json looks for it.
namespace qddot {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Counts, steps, rejected, force_evaluations,
                                   stiffness_evaluations, factorizations, solves, newton_iterations,
                                   indefinite_factorizations, order_sum, order_reductions,
                                   stability_limited_steps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Summary, outcome, t_reached, counts, message, energy_growth,
                                   failed_step)

}  // namespace qddot
