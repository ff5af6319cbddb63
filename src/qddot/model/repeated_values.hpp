#pragma once

#include <array>
#include <cstring>
#include <vector>

namespace qddot {

// Values that consist of doubles alone, such as laws of springs. One that was added shortly before
// is not stored again, so that those of a grid are few.
template <class Value>
class RepeatedValues {
 public:
  RepeatedValues() { recent_.fill(-1); }

  // Adds a value and returns its number.
  int number(const Value& value) {
    int& recent = recent_[hash(value) >> (64 - log2_recent)];
    // By their bytes: zeros of both signs are different values.
    if (recent < 0 || std::memcmp(&values_[recent], &value, sizeof value) != 0) {
      recent = static_cast<int>(values_.size());
      values_.push_back(value);
    }
    return recent;
  }

  const Value& operator[](int number) const { return values_[number]; }
  // By their numbers.
  const std::vector<Value>& values() const { return values_; }

 private:
  static constexpr int log2_recent = 8;

  static unsigned long hash(const Value& value) {
    // Spreads the bits over the first ones (Knuth, The Art of Computer Programming 3, 6.4).
    constexpr unsigned long factor = 0x9e3779b97f4a7c15;
    std::array<unsigned long, sizeof(Value) / sizeof(double)> words;
    static_assert(sizeof words == sizeof value);
    std::memcpy(&words, &value, sizeof value);
    unsigned long bits = 0;
    for (const unsigned long word : words) bits = (bits ^ word) * factor;
    return bits;
  }

  std::vector<Value> values_;
  std::array<int, 1 << log2_recent> recent_;  // numbers, by the first bits of the hash
};

}  // namespace qddot
