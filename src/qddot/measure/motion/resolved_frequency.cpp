#include "qddot/measure/motion/resolved_frequency.hpp"

#include <algorithm>

#include "qddot/analysis/frequency_bound.hpp"

namespace qddot::inline measure {

double resolved_frequency(const Method& method, const System& system, const Vec& q) {
  if (!method.asks(Need::split_forces) || method.is(Trait::implicit))
    return frequency_bound(system, q);
  if (const Split* split = split_of(system)) return frequency_bound(*split->soft, q);
  double largest = 0;
  Index first = 0;
  for (const auto& block : blocks_of(system)) {
    const Vec own = q.segment(first, block->size());
    largest = std::max(largest, resolved_frequency(method, *block, own));
    first += block->size();
  }
  return largest;
}

}  // namespace qddot::inline measure
