#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "qddot/model/kernels/neighbours.hpp"
#include "qddot/model/kernels/spring_kernels.hpp"
#include "qddot/model/system.hpp"

namespace qddot::kernels {

// Vectors of `slice_rows` numbers. One that was seen shortly before is not stored again, so that
// those of a grid are few.
class SharedVectors {
 public:
  SharedVectors() { recent_.fill(-1); }

  // The place of number(0), number(1), ... among all numbers.
  template <class Number>
  int place(const Number& number) {
    std::array<double, slice_rows> numbers;
    unsigned long bits = 0;
    for (int t = 0; t < slice_rows; ++t) {
      numbers[t] = number(t);
      bits = (bits ^ std::bit_cast<unsigned long>(numbers[t])) * hash_factor;
    }
    int& recent = recent_[bits >> (64 - log2_recent)];
    // By their bytes: zeros of both signs are different numbers.
    if (recent < 0 || std::memcmp(&numbers_[recent], &numbers, sizeof numbers) != 0) {
      recent = static_cast<int>(numbers_.size());
      numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
    }
    return recent;
  }

  Vec numbers() const { return Eigen::Map<const Vec>(numbers_.data(), std::ssize(numbers_)); }

 private:
  static constexpr int log2_recent = 8;

  std::vector<double> numbers_;
  std::array<int, 1 << log2_recent> recent_;  // places, by the first bits of a hash
};

}  // namespace qddot::kernels
