#pragma once

#include <string>
#include <vector>

// Whether the text holds all of the fragments.
inline bool contains(const std::string& text, const std::vector<std::string>& fragments) {
  for (const std::string& fragment : fragments) {
    if (text.find(fragment) == text.npos) return false;
  }
  return true;
}
