#include "qddot/scene/generators.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/scene/generators/ranges.hpp"
#include "qddot/scene/invalid_input.hpp"

// One line a generator; each is defined in the file of its name.
#define QDDOT_GENERATORS(GENERATOR) \
  GENERATOR(oscillator)             \
  GENERATOR(orbit)                  \
  GENERATOR(pair)                   \
  GENERATOR(pendulum)               \
  GENERATOR(shaken_pendulum)        \
  GENERATOR(chain)                  \
  GENERATOR(plucked_string)         \
  GENERATOR(bowed_string)           \
  GENERATOR(cloth)                  \
  GENERATOR(framed_cloth)           \
  GENERATOR(hemmed_cloth)           \
  GENERATOR(lattice)                \
  GENERATOR(fpu)                    \
  GENERATOR(fput)                   \
  GENERATOR(cable_net)              \
  GENERATOR(bridge)                 \
  GENERATOR(strut)

namespace qddot {

#define QDDOT_DECLARE(generator) Generator generator();
QDDOT_GENERATORS(QDDOT_DECLARE)

namespace {

// Adds the parameters that every generator takes.
Generator with_damping(Generator generator) {
  generator.parameters.push_back(
      {"damping_time", 0, 0, most, "c/k of a dashpot beside each spring in s"});
  generator.parameters.push_back(
      {"air_damping", 0, 0, most, "alpha of the air's force -alpha m v in 1/s"});
  return generator;
}

}  // namespace

const std::vector<Generator>& generators() {
#define QDDOT_CALL(generator) with_damping(generator()),
  static const std::vector<Generator> all = {QDDOT_GENERATORS(QDDOT_CALL)};
  return all;
}

const Generator* find_generator(const std::string& name) {
  const auto found = std::ranges::find(generators(), name, &Generator::name);
  return found == generators().end() ? nullptr : &*found;
}

namespace {

void require(const GeneratorParameter& parameter, double value, const std::string& source) {
  const bool in_range = value >= parameter.low && value <= parameter.high;
  if (in_range && (!parameter.whole || value == std::floor(value))) return;
  throw InvalidInput(fmt::format("{}: {} = {} is not allowed; it is {}, {} from {} to {}", source,
                                 parameter.name, value, parameter.meaning,
                                 parameter.whole ? "a whole number" : "a number", parameter.low,
                                 parameter.high));
}

}  // namespace

Scene generate(const Generator& generator, const GeneratorValues& values, const std::string& source,
               const SceneLimits& limits) {
  GeneratorValues complete;
  std::vector<std::string> names;
  for (const auto& parameter : generator.parameters) {
    complete[parameter.name] = parameter.standard;
    names.push_back(parameter.name);
  }
  for (const auto& [name, value] : values) {
    if (!complete.contains(name)) {
      throw InvalidInput(fmt::format("{}: {} is not a parameter of generator {}; allowed are {}",
                                     source, name, generator.name, fmt::join(names, ", ")));
    }
    complete[name] = value;
  }
  for (const auto& parameter : generator.parameters) {
    require(parameter, complete[parameter.name], source);
  }
  require_within(limits, generator.size(complete), source);
  Scene scene = generator.draw(complete);
  scene.name = generator.name;
  scene.air_damping = complete.at("air_damping");
  damp_springs(complete.at("damping_time"), scene);
  validate(scene, source);
  return scene;
}

}  // namespace qddot
