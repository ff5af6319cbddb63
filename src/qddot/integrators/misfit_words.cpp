#include "qddot/integrators/misfit_words.hpp"

#include <fmt/format.h>

namespace qddot {

std::string misfit_words(const Method& method, Outcome why) {
  if (why != Outcome::refuses_damping || !*method.why_not_damped) return std::string(advice(why));
  return fmt::format(
      "it refuses this damping, since {}: take verlet, symmetric4, rk4 or an implicit method",
      method.why_not_damped);
}

}  // namespace qddot
