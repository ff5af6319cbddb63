#pragma once

#include <map>
#include <string>
#include <vector>

#include "qddot/scene/scene.hpp"
#include "qddot/scene/scene_limits.hpp"

namespace qddot {

// A number that a scene generator takes; an integer if `whole`.
struct GeneratorParameter {
  std::string name;
  double standard;      // the value if none is given
  double low, high;     // both allowed
  std::string meaning;  // with its unit
  bool whole = false;
};

using GeneratorValues = std::map<std::string, double>;

// A family of scenes drawn from a few numbers.
struct Generator {
  std::string name;
  std::string summary;
  std::vector<GeneratorParameter> parameters;
  // The size of the scene that draw() draws, known before it is drawn. `values` holds every
  // parameter, for draw() too.
  SceneSize (*size)(const GeneratorValues& values);
  Scene (*draw)(const GeneratorValues& values);
};

// All generators, in the order in which they are listed.
const std::vector<Generator>& generators();

// The generator of that name, or nullptr.
const Generator* find_generator(const std::string& name);

// Draws the scene; parameters that `values` does not name take their standard value. Throws
// InvalidInput, in a sentence that starts with `source`, for an unknown parameter and for a scene
// beyond the limits. It does so too for a value that is not finite, not whole if it must be, or
// outside [low, high].
Scene generate(const Generator& generator, const GeneratorValues& values, const std::string& source,
               const SceneLimits& limits = {});

}  // namespace qddot
