#pragma once

#include <string_view>
#include <vector>

#include "qddot/integrators/method.hpp"

namespace qddot {

// Every method there is, in the order in which it is listed and drawn.
const std::vector<Method>& methods();

// The method of that name, or nullptr.
const Method* find_method(std::string_view name);

// An integrator for `system`, which must outlive it; allocates and analyses all it needs. Each
// block of a system of blocks gets an integrator of its own. Where the method does not fit the
// system (see misfit), advance() says why and does nothing. Throws std::invalid_argument, naming
// the option, its value and what is allowed, where an option cannot be (check_options).
std::unique_ptr<Integrator> make_integrator(const Method& method, const System& system,
                                            const Options& options);

}  // namespace qddot
