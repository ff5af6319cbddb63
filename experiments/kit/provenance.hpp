#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "qddot/scene/model.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline kit::build_info {

// Filled in by build_info.cmake at build time.
extern const char* const version;      // git describe, or the project's version
extern const char* const source_hash;  // SHA-256 of src, integrators and experiments
extern const char* const compiler;
extern const char* const flags;

}  // namespace qddot::inline kit::build_info

namespace qddot::inline kit {

// The record of how a result was made: command line, date (UTC), version of the code, compiler and
// flags. It also has the kernels' level and roots, the BLAS with its code's processor, processor
// and libraries.
nlohmann::json provenance(const std::vector<std::string>& command_line);

// The same with the scene and its content hash.
nlohmann::json provenance(const std::vector<std::string>& command_line, const Scene& drawn);

// The same with the reductions of the scene and the rest (see Explanation, whose eigenvalues are
// null for scenes that are not at_a_glance). `start`: the scene as it starts.
nlohmann::json provenance(const std::vector<std::string>& command_line, const Scene& drawn,
                          const Scene& start, const Model& model);

// The properties of the machine that decide the times and the rounding of runs: processor ("cpu"),
// level of the kernels, libraries.
nlohmann::json machine();
// The name of the roots that this process uses. Each process times them anew and all give the same
// bits, so they are recorded but belong to no key.
std::string_view roots();
// The properties of the build, equal on all machines of a study: hash of the sources ("code"),
// compiler and flags.
nlohmann::json build();

// This machine's name in its network.
std::string host();

// The present time by this machine's clock, as 2026-01-31T12:00:00Z (UTC).
std::string date_now();

}  // namespace qddot::inline kit
