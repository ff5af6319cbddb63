#pragma once

#include <optional>

#include "experiments/advice/drawn_case.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/scene/generators.hpp"

namespace qddot {
inline namespace tests {

inline Scene drawn(const char* generator, const GeneratorValues& values = {}) {
  return generate(*find_generator(generator), values, generator);
}

// The judge of the case: a reference that is ten times as accurate as the requested accuracy. Empty
// if the case has more nodes, if nothing moves in it, or if no such reference is found in about
// `seconds`.
inline std::optional<measure::Reference> judge(const judged_advice::Case& drawn, const Model& model,
                                               std::size_t most_nodes, double seconds) {
  constexpr double part = 0.1;
  if (model.system().size() == 0 || drawn.scene.nodes.size() > most_nodes) return {};
  try {
    const measure::Reference reference = measure::make_reference(model, drawn.until, seconds);
    if (reference.certified.position <= part * drawn.accuracy) return reference;
  } catch (const measure::NoReference&) {
  }
  return {};
}

}  // namespace tests
}  // namespace qddot
