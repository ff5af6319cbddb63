#include "qddot/algebra/blocks.hpp"

#include <algorithm>
#include <span>

namespace qddot {
namespace {

bool same_column(const SymmetricMatrix& a, int i, int j) {
  const auto column = [&](int k) {
    return std::span(a.innerIndexPtr() + a.outerIndexPtr()[k],
                     a.innerIndexPtr() + a.outerIndexPtr()[k + 1]);
  };
  return std::ranges::equal(column(i), column(j));
}

}  // namespace

std::vector<int> block_starts(const SymmetricMatrix& pattern) {
  const SymmetricMatrix whole = pattern.selfadjointView<Eigen::Lower>();
  const int n = static_cast<int>(pattern.rows());
  std::vector<int> starts;
  for (int j = 0; j < n; ++j) {
    if (j == 0 || j - starts.back() == most_block_unknowns || !same_column(whole, j - 1, j)) {
      starts.push_back(j);
    }
  }
  starts.push_back(n);
  return starts;
}

}  // namespace qddot
