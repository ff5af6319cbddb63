#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

namespace qddot {
inline namespace tests {

// Numbers as the bytes of a file in an order.
class BinaryText {
 public:
  explicit BinaryText(std::endian order, std::string start = "")
      : order_(order), text_(std::move(start)) {}

  template <class Number, class... Values>
  BinaryText& put(Values... values) {
    (put_one(static_cast<Number>(values)), ...);
    return *this;
  }
  BinaryText& text(const std::string& more) {
    text_ += more;
    return *this;
  }
  const std::string& str() const { return text_; }

 private:
  template <class Number>
  void put_one(Number number) {
    char bytes[sizeof(Number)];
    std::memcpy(bytes, &number, sizeof(Number));
    if (order_ != std::endian::native) std::reverse(bytes, bytes + sizeof(Number));
    text_.append(bytes, sizeof(Number));
  }

  std::endian order_;
  std::string text_;
};

}  // namespace tests
}  // namespace qddot
