#pragma once

#include <string>

namespace qddot::inline kit {

// The 64-bit FNV-1a hash of a text, as 16 hexadecimal digits.
std::string text_hash(const std::string& text);

}  // namespace qddot::inline kit
