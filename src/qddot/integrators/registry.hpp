#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "qddot/integrators/method.hpp"

namespace qddot {

// All methods, in the order in which they are listed and drawn.
const std::vector<Method>& methods();

// The methods that a newer SUNDIALS than this build's would bring. They cannot run.
const std::vector<Method>& newer_methods();

// The version of SUNDIALS that a method of newer_methods() needs, as words: "7.1"; else empty.
std::string sundials_needed(const Method& method);

// The sentence that refuses one of newer_methods(); empty for any other name.
std::string why_not_built(std::string_view name);

// The method of that name, or nullptr.
const Method* find_method(std::string_view name);

// Makes an integrator for `system`, which must outlive it. Throws std::invalid_argument for an
// option that is not allowed (see check_options).
std::unique_ptr<Integrator> make_integrator(const Method& method, const System& system,
                                            const Options& options);

}  // namespace qddot
