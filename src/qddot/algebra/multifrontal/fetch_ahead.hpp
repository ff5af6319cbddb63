#pragma once

#include <algorithm>
#include <span>

#include "qddot/algebra/multifrontal/front_kernels.hpp"

namespace qddot::multifrontal {

// Fetches the entries of K of the next front while the tiles of the present one are computed, a
// share with each. They lie all over K: to wait for them took a tenth of a factorisation.
class FetchAhead {
 public:
  // k: K's values; shares: the number of calls of fetch_share() that fetch all.
  FetchAhead(const double* k, std::span<const Entry> entries, int shares)
      : k_(k), rest_(entries), share_(entries.size() / static_cast<std::size_t>(shares + 1) + 1) {}

  void fetch_share() {
    const std::span<const Entry> share = rest_.first(std::min(share_, rest_.size()));
    for (const Entry& entry : share) __builtin_prefetch(k_ + entry.source);
    rest_ = rest_.subspan(share.size());
  }

 private:
  const double* k_;
  std::span<const Entry> rest_;
  std::size_t share_;
};

}  // namespace qddot::multifrontal
