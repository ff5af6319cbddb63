#include "qddot/measure/motion/resolved_frequency.hpp"

#include <algorithm>

#include "qddot/analysis/frequency_bound.hpp"

namespace qddot::measure {

double resolved_frequency(const Method& method, const System& system, const Vec& q) {
  if (!method.needs_split || method.implicit) return frequency_bound(system, q);
  if (system.split()) return frequency_bound(*system.split()->soft, q);
  double largest = 0;
  Index first = 0;
  for (const auto& part : system.parts()) {
    const Vec own = q.segment(first, part->size());
    largest = std::max(largest, resolved_frequency(method, *part, own));
    first += part->size();
  }
  return largest;
}

}  // namespace qddot::measure
