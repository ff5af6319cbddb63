#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/text_file.hpp"

namespace qddot::mesh {

// The numbers of a binary file from a byte on, in the order of bytes of the machine that wrote it.
class Bytes {
 public:
  // `content` and `file` must outlive this.
  Bytes(std::string_view content, const std::string& file) : content_(content), file_(file) {}

  std::endian order = std::endian::little;
  std::size_t at = 0;  // the next byte

  std::size_t left() const { return content_.size() - at; }

  // The next number. Throws InvalidInput, in a sentence that names `field`, if the file ends in it.
  template <class Number>
  Number take(std::string_view field) {
    std::array<char, sizeof(Number)> bytes;
    if (left() < bytes.size())
      refuse(field, "", fmt::format("are {} bytes more", bytes.size() - left()));
    std::memcpy(bytes.data(), content_.data() + at, bytes.size());
    at += bytes.size();
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<Number>(bytes);
  }

  // Throws InvalidInput: `value`, which ends before the next byte, is not one of those `allowed`;
  // without a value, the file ends too early.
  [[noreturn]] void refuse(std::string_view field, std::string_view value,
                           std::string_view allowed) const {
    throw InvalidInput(fmt::format(
        "{}: before byte {}: {}: {}; allowed {}", file_, at, field,
        value.empty() ? "the file ends too early" : fmt::format("{} is not allowed", shown(value)),
        allowed));
  }

 private:
  std::string_view content_;
  const std::string& file_;
};

}  // namespace qddot::mesh
