#pragma once

#include <optional>
#include <string_view>

#include "qddot/integrators/integrator.hpp"

namespace qddot {

// The outcome of that name (see name(Outcome)); nothing if there is none.
inline std::optional<Outcome> find_outcome(std::string_view word) {
  for (int i = 0; i <= static_cast<int>(Outcome::no_discrete_gradient); ++i) {
    if (name(static_cast<Outcome>(i)) == word) return static_cast<Outcome>(i);
  }
  return {};
}

}  // namespace qddot
