#include "qddot/integrators/base/nystrom_stages.hpp"

#include <algorithm>

namespace qddot {

bool NystromPair::is_first_same_as_last() const {
  return c.back() == 1 && std::equal(a.back().begin(), a.back().end(), b.begin()) && b.back() == 0;
}

}  // namespace qddot
