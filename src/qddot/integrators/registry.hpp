#pragma once

#include <string_view>
#include <vector>

#include "qddot/integrators/method.hpp"

namespace qddot {

// All methods, in the order in which they are listed and drawn.
const std::vector<Method>& methods();

// The method of that name, or nullptr.
const Method* find_method(std::string_view name);

// Makes an integrator for `system`, which must outlive it. Throws std::invalid_argument for an
// option that is not allowed (see check_options).
std::unique_ptr<Integrator> make_integrator(const Method& method, const System& system,
                                            const Options& options);

}  // namespace qddot
