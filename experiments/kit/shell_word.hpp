#pragma once

#include <string>

namespace qddot::inline kit {

// The word as a shell reads it back: quoted if necessary.
std::string shell_word(const std::string& word);

}  // namespace qddot::inline kit
