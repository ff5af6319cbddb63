#pragma once

#include <map>
#include <string>
#include <vector>

#include "src/scene/scene.hpp"

namespace qddot {

// A number that a scene generator takes. `whole` asks for an integer.
struct GeneratorParameter {
  std::string name;
  double standard;      // the value where none is given
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
  Scene (*draw)(const GeneratorValues& values);  // `values` holds every parameter
};

// All generators, in the order in which they are listed.
const std::vector<Generator>& generators();

// The generator of that name, or nullptr.
const Generator* find_generator(const std::string& name);

// Draws the scene; parameters that `values` does not name take their standard value. Throws
// InvalidInput, in a sentence that starts with `source`, for an unknown parameter or a value that
// is not finite, not whole where it must be, or outside [low, high].
Scene generate(const Generator& generator, const GeneratorValues& values,
               const std::string& source);

}  // namespace qddot
