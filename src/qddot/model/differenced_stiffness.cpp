#include "qddot/model/differenced_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "qddot/model/machine_epsilon.hpp"

namespace qddot {
namespace {

// The columns with an entry in each row, the diagonal one first.
std::vector<std::vector<Index>> neighbours(const std::vector<std::pair<Index, Index>>& pairs,
                                           Index n) {
  std::vector<std::vector<Index>> rows(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) rows[static_cast<std::size_t>(i)].push_back(i);
  for (const auto& [i, j] : pairs) {
    if (i < 0 || j < 0 || i >= n || j >= n) {
      throw std::invalid_argument(
          fmt::format("the pair ({}, {}) is not among the {} unknowns", i, j, n));
    }
    rows[static_cast<std::size_t>(i)].push_back(j);
    rows[static_cast<std::size_t>(j)].push_back(i);
  }
  for (auto& row : rows) {
    std::ranges::sort(row);
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  return rows;
}

// The columns of each colour. Each column takes the first colour in which no other column shares a
// row with it.
std::vector<std::vector<Index>> coloured(const std::vector<std::vector<Index>>& rows) {
  std::vector<std::vector<Index>> columns_of;
  std::vector<std::size_t> colour_of(rows.size(), std::numeric_limits<std::size_t>::max());
  std::vector<Index> taken_by;  // for each colour, the last column that it could not take
  for (std::size_t j = 0; j < rows.size(); ++j) {
    for (const Index row : rows[j]) {
      for (const Index other : rows[static_cast<std::size_t>(row)]) {
        const std::size_t colour = colour_of[static_cast<std::size_t>(other)];
        if (colour < taken_by.size()) taken_by[colour] = static_cast<Index>(j);
      }
    }
    const auto free =
        std::ranges::find_if(taken_by, [&](Index last) { return last != static_cast<Index>(j); });
    colour_of[j] = static_cast<std::size_t>(free - taken_by.begin());
    if (free == taken_by.end()) {
      taken_by.push_back(-1);
      columns_of.emplace_back();
    }
    columns_of[colour_of[j]].push_back(static_cast<Index>(j));
  }
  return columns_of;
}

SymmetricMatrix lower_pattern(const std::vector<std::vector<Index>>& rows) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    for (const Index i : rows[j]) {
      if (i >= static_cast<Index>(j)) entries.emplace_back(i, static_cast<Index>(j), 0);
    }
  }
  const auto n = static_cast<Index>(rows.size());
  SymmetricMatrix pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  return pattern;
}

}  // namespace

DifferencedStiffness::DifferencedStiffness(std::shared_ptr<const System> system,
                                           const std::vector<std::pair<Index, Index>>& pairs,
                                           double length)
    : System(system->mass()),
      system_(std::move(system)),
      rows_of_(neighbours(pairs, size())),
      length_(length) {
  if (!(length > 0 && std::isfinite(length))) {
    throw std::invalid_argument(
        fmt::format("length = {:g} is not allowed; it is a length in m above 0", length));
  }
  pattern_ = lower_pattern(rows_of_);
  columns_of_ = coloured(rows_of_);
}

void DifferencedStiffness::stiffness(const At& at, SymmetricMatrix& k) const {
  const VecView& q = at.q;
  const double largest = q.size() > 0 ? q.lpNorm<Eigen::Infinity>() : 0;
  const double d = std::cbrt(machine_epsilon) * std::max(length_, largest);
  Vec moved = q, ahead(size()), behind(size());
  k.coeffs().setZero();
  for (const auto& columns : columns_of_) {
    for (const Index j : columns) moved[j] = q[j] + d;
    system_->force({at.t, moved, at.v}, ahead);
    for (const Index j : columns) moved[j] = q[j] - d;
    system_->force({at.t, moved, at.v}, behind);
    for (const Index j : columns) {
      const double width = (q[j] + d) - (q[j] - d);  // the difference as rounded
      moved[j] = q[j];
      // Half of each entry off the diagonal comes from its own column, half from its mirror image.
      for (const Index i : rows_of_[static_cast<std::size_t>(j)]) {
        const double entry = (ahead[i] - behind[i]) / width;
        k.coeffRef(std::max(i, j), std::min(i, j)) += i == j ? entry : 0.5 * entry;
      }
    }
  }
}

}  // namespace qddot
