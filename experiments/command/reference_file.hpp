#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "qddot/measure/reference/reference.hpp"

namespace qddot::command {

using namespace measure;

// As JSON, numbers exact, with `certified_position`, `certified_velocity`, `certified_energy` and
// their decimal digits; and back. from_json throws nlohmann::json::exception for anything else.
nlohmann::json to_json(const Reference& reference);
Reference reference_from_json(const nlohmann::json& json);

// Throws InvalidInput if no reference can be made of the scene, since a free node has no mass.
void require_reference_exists(const ReducedScene& scene, const std::string& source);

// The reference of the scene at `until` that `folder`/reference.json holds, if it was made of the
// same scene content by the same code, its checksum is right and its end has the energy of the
// start; else a new one, which is written there with `origin`. A file that is not as it was written
// is said to be, on stderr. It is
// as good as can be, or good to the position error `needed` where that is given. `start` is the
// drawn scene as its motion starts, and `scene` the reduction of that.
Reference reference_for(const Scene& drawn, const Scene& start, const ReducedScene& scene,
                        double until, const std::string& folder, const nlohmann::json& origin,
                        std::optional<double> needed = {});

// The reference that reference_for would find. Throws InvalidInput where there is none.
Reference kept_reference(const Scene& drawn, const ReducedScene& scene, double until,
                         const std::string& folder);

}  // namespace qddot::command
