#pragma once

#include <nlohmann/json.hpp>

#include "qddot/integrators/integrator.hpp"

// The records of a run's Summary and Counts in a journal, by the names of their members; Seconds
// are left out. They are in the namespace of these types, where nlohmann::json looks for them.
namespace qddot {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Counts, steps, rejected, force_evaluations,
                                   stiffness_evaluations, factorizations, solves, newton_iterations,
                                   indefinite_factorizations, order_sum, order_reductions,
                                   stability_limited_steps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Summary, outcome, t_reached, counts, message, energy_growth,
                                   failed_step)

}  // namespace qddot
