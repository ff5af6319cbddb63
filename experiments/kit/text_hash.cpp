#include "experiments/kit/text_hash.hpp"

#include <cstdint>

#include <fmt/format.h>

namespace qddot::inline kit {

std::string text_hash(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x00000100000001b3ULL;
  return fmt::format("{:016x}", hash);
}

}  // namespace qddot::inline kit
