#pragma once

#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/invalid_input.hpp"
#include "tests/fragments.hpp"

namespace qddot {
inline namespace tests {

// The sentence of a refusal; empty if the input is accepted.
template <class Reading>
std::string refusal_of(const Reading& reading) {
  try {
    reading();
    return "";
  } catch (const InvalidInput& error) {
    return error.what();
  }
}

// Whether a refusal is one line that holds the fragments.
inline bool names_all(const std::string& message, const std::vector<std::string>& fragments) {
  return contains(message, fragments) && !message.empty() && message.find('\n') == message.npos;
}

// `text` with the first `old_part`, which must be there, replaced.
inline std::string with(std::string text, const std::string& old_part,
                        const std::string& new_part) {
  const std::size_t at = text.find(old_part);
  BOOST_REQUIRE(at != text.npos);
  return text.replace(at, old_part.size(), new_part);
}

}  // namespace tests
}  // namespace qddot
