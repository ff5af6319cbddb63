#pragma once

#include <string>

namespace qddot::python {

// The sentence with the programs' options as Python spells them: step_size for --step-size, and
// keep for --no-reduce.
std::string in_python(const std::string& sentence);

}  // namespace qddot::python
