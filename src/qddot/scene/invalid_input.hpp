#pragma once

#include <stdexcept>

namespace qddot {

// The user's input cannot be taken. what() is one sentence with the file or option, the entry and
// field, the value, and what is allowed. Programs print it and exit with status 2.
class InvalidInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace qddot
