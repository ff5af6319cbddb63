#pragma once

#include <string>
#include <vector>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/stability_map/modal_step.hpp"

namespace qddot::stability_map {

// The columns of modal.csv.
const std::vector<std::string>& modal_columns();

// Writes a row for each method that has a step of its own and each of a dozen natural modes of the
// scene at rest. A row has the damping ratio, period error and spectral radius, predicted on an
// oscillator and measured by exciting the mode, and the verdict. If a method fails to make the
// steps, the reason replaces the verdict. h = `step_size` [s], or 1/w_max if that is 0. Runs on all
// cores (OpenMP); the rows of a method are a piece of the study.
void tabulate_modes(Study& study, Csv& csv, const std::vector<const Method*>& methods,
                    const ReducedScene& rest, double step_size);

}  // namespace qddot::stability_map
