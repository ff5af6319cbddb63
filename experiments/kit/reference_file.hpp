#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "experiments/kit/scene_choice.hpp"
#include "qddot/measure/reference/reference.hpp"

namespace qddot::inline kit {

// Converts a reference to JSON and back, with exact numbers, and with `certified_position`,
// `certified_velocity`, `certified_energy` and their decimal digits. reference_from_json throws
// nlohmann::json::exception for anything else.
nlohmann::json to_json(const Reference& reference);
Reference reference_from_json(const nlohmann::json& json);

// Reads what a file says of a reference without its end state, as a file that was kept may. It is
// lenient: what is missing is not known. Throws nlohmann::json::exception for values of other
// types.
Reference reference_without_end(const nlohmann::json& json);

// Throws InvalidInput if no reference can be made of the scene, since a free node has no mass.
void require_reference_exists(const Model& scene, const std::string& source);

void require_reference_exists(const Subject& subject);

// The reference of the scene at the time `until` [s]. It is read from `folder`/reference.json if
// the same code made it of the same scene. Its checksum must be right, and its end must have the
// energy of the start. Else it is made and written there with `origin`; a message on stderr says if
// the file was damaged. A new reference is as accurate as possible, or has the position error
// `needed` if that is given. `start` is the drawn scene as its motion starts, and `scene` the
// reduction of `start`.
Reference reference_for(const Scene& drawn, const Scene& start, const Model& scene, double until,
                        const std::string& folder, const nlohmann::json& origin,
                        std::optional<double> needed = {});

Reference reference_for(const Subject& subject, const std::string& folder,
                        const nlohmann::json& origin);

// The reference that reference_for would read. Throws InvalidInput if there is none.
Reference kept_reference(const Subject& subject, const std::string& folder);

}  // namespace qddot::inline kit
