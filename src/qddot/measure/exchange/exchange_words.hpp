#pragma once

#include <string>

#include "qddot/integrators/integrator.hpp"
#include "qddot/measure/exchange/energy_exchange.hpp"

namespace qddot::inline measure {

// The verdict on a run of `exchange` that did not reach its end: its outcome and when.
std::string verdict_on(const Summary& summary);

// The verdict on a course against the reference's. Its springs exchange energy as they should, too
// fast, too slowly or not at all, or they lose or gain energy. `reference`: the reference compared
// with itself.
std::string verdict_on(const ExchangeComparison& c, const ExchangeComparison& reference);

}  // namespace qddot::inline measure
