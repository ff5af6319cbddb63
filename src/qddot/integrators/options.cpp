#include "qddot/integrators/options.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "qddot/integrators/option_table.hpp"

namespace qddot {

void check_options(const Method& method, const Options& options) {
  for (const OptionRow& row : option_rows()) {
    // The other knob may have any value. An option that the method ignores may not.
    if (std::holds_alternative<Knob>(row.takers) && !takes(method, row)) continue;
    const double value =
        std::visit([&](auto member) { return static_cast<double>(options.*member); }, row.member);
    if (row.accepts(value)) continue;
    throw std::invalid_argument(fmt::format("{}: {} = {:g} is not allowed; it is {}", method.name,
                                            row.name, value, row.allowed));
  }
}

}  // namespace qddot
