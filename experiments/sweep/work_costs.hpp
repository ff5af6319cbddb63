#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "experiments/sweep/task.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::sweep {

// The time [s] on one machine of each thing that methods count on a scene; zero where the scene has
// none of it.
struct WorkCosts {
  double force = 0, stiffness = 0, factorization = 0, solve = 0;
};

// Measures the costs now, each as the least of many calls: f and K at the start, the numeric
// factorisation of M - h^2 K, and a solve with it. h = 1 / w_max makes the matrix positive definite
// if K allows.
WorkCosts measured_costs(const ReducedScene& scene);

// The costs on the scene of the task, on this machine: kept in `folder`/costs.json, or measured and
// kept there.
WorkCosts costs_for(const Task& task, const std::string& folder);

// A piece that is a point (see record_of), its times replaced by counts times costs; anything else
// as it is. What a step does beside forces and solves counts nothing.
nlohmann::json by_work(nlohmann::json piece, const WorkCosts& costs);

}  // namespace qddot::sweep
