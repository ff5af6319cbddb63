#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {

// The entry of that name. Throws InvalidInput, with the names of all, if there is none; `option`
// and `what` it names are for the sentence.
template <class Entry>
const Entry& named(const std::string& name, const std::vector<Entry>& all,
                   std::string Entry::*own_name, const std::string& option,
                   const std::string& what) {
  const auto found = std::ranges::find(all, name, own_name);
  if (found != all.end()) return *found;
  std::vector<std::string> names;
  for (const Entry& entry : all) names.push_back(entry.*own_name);
  throw InvalidInput(
      fmt::format("{}: {} is not {}; allowed are {}", option, name, what, fmt::join(names, ", ")));
}

// Throws InvalidInput if a value of the list is there twice.
template <class T>
void require_each_once(const std::vector<T>& values, const std::string& option) {
  for (auto value = values.begin(); value != values.end(); ++value) {
    if (std::find(values.begin(), value, *value) != value)
      throw InvalidInput(fmt::format("{}: {} is named twice; allowed is once", option, *value));
  }
}

}  // namespace qddot::inline kit
