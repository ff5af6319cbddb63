#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "qddot/scene/reduce/reduced_scene.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::command {

// Where a result comes from: command line, version of the code, compiler and flags, the kernels'
// level, processor, libraries, date (UTC).
nlohmann::json provenance(const std::vector<std::string>& command_line);

// The same with the scene and its content hash.
nlohmann::json provenance(const std::vector<std::string>& command_line, const Scene& drawn);

// The same with what was left out of the scene and what is left: see Explanation, whose eigenvalues
// are null for scenes that are not at_a_glance. `start`: the
// scene as it starts.
nlohmann::json provenance(const std::vector<std::string>& command_line, const Scene& drawn,
                          const Scene& start, const ReducedScene& reduced);

// What of a machine decides how long its runs take and how they round: processor ("cpu"), level of
// the kernels, roots, libraries.
nlohmann::json machine();
// What is built alike wherever results are: hash of the sources ("code"), compiler and flags.
nlohmann::json build();

// This machine's name in its network.
std::string host();

// Now, by this machine's clock, as 2026-01-31T12:00:00Z (UTC).
std::string date_now();

// Hash of all sources that decide a motion; changes when the code does.
std::string code_hash();

}  // namespace qddot::command
