#pragma once

#include <vector>

#include "experiments/advice/judged_motion.hpp"

namespace qddot::judged_advice {

// Gives the relative errors of positions that a run has at the times of the true motion, as far as
// the run goes.
std::vector<double> errors_at_looks(const Method& method, double value, const JudgedMotion& motion);

// Gives for each of these times the largest such error at an end of a step, from the start to the
// first end at that time or later. It compares the ends beside these times with the fine run, and
// leaves out the error of that. The system has no massless nodes.
std::vector<double> errors_at_steps(const Method& method, double value, const JudgedMotion& motion);

}  // namespace qddot::judged_advice
