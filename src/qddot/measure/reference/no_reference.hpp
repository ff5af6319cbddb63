#pragma once

#include <stdexcept>

namespace qddot::inline measure {

// The high-accuracy methods did not reach the end.
class NoReference : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace qddot::inline measure
