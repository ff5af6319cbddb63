#include "qddot/integrators/misfit_words.hpp"

#include <fmt/format.h>

namespace qddot {

std::string misfit_words(const Method& method, Outcome why) {
  if (why != Outcome::refuses_damping || !*method.why_not_damped) return std::string(advice(why));
  return fmt::format("it refuses this damping, since {}: take {}", method.why_not_damped,
                     method.asks(Need::constraints)
                         ? "rattle, arkode_erk8_rods or ida_rods"
                         : "verlet, symmetric4, rk4 or an implicit method");
}

}  // namespace qddot
