#pragma once

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace qddot {

// The fewest letters to insert, leave out or replace that make one word of the other (Levenshtein
// 1966).
inline std::size_t letters_apart(std::string_view one, std::string_view other) {
  std::vector<std::size_t> row(other.size() + 1);  // of the first i letters of `one`
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < one.size(); ++i) {
    std::size_t before = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < other.size(); ++j) {
      const std::size_t replaced = before + (one[i] == other[j] ? 0 : 1);
      before = row[j + 1];
      row[j + 1] = std::min({replaced, before + 1, row[j] + 1});
    }
  }
  return row.back();
}

// The name that is nearest to a misspelt one: at most a third of its letters differ. Empty if there
// is none.
inline std::string nearest_name(std::string_view name, const std::vector<std::string>& names) {
  constexpr std::size_t longest = 100;
  const auto apart = [&](const std::string& other) { return letters_apart(name, other); };
  if (names.empty() || name.size() > longest) return "";
  const std::string& nearest = *std::ranges::min_element(names, {}, apart);
  return 3 * apart(nearest) <= std::min(name.size(), nearest.size()) ? nearest : "";
}

}  // namespace qddot
