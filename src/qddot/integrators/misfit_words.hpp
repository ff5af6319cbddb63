#pragma once

#include <string>

#include "qddot/integrators/method.hpp"

namespace qddot {

// Why `method` does not fit a system, for an outcome of misfit(), and what to take instead:
// "refuses this damping, since its substeps drift back in time ...".
std::string misfit_words(const Method& method, Outcome why);

}  // namespace qddot
