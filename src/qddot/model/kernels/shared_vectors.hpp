#pragma once

#include <cstring>
#include <string_view>
#include <unordered_set>

#include "qddot/model/kernels/spring_kernels.hpp"
#include "qddot/model/system.hpp"

namespace qddot::kernels {

// Vectors of `slice_rows` numbers, each different one stored once.
class SharedVectors {
 public:
  SharedVectors() = default;
  SharedVectors(const SharedVectors&) = delete;
  SharedVectors& operator=(const SharedVectors&) = delete;

  // The place of number(0), number(1), ... among all numbers.
  template <class Number>
  int place(const Number& number) {
    const auto place = static_cast<int>(numbers_.size());
    for (int t = 0; t < slice_rows; ++t) numbers_.push_back(number(t));
    const auto [found, is_new] = places_.insert(place);
    if (!is_new) numbers_.resize(place);
    return *found;
  }

  Vec numbers() const { return Eigen::Map<const Vec>(numbers_.data(), std::ssize(numbers_)); }

 private:
  // By their bytes: zeros of both signs are different numbers.
  std::string_view bytes(int place) const {
    return {reinterpret_cast<const char*>(numbers_.data() + place), slice_rows * sizeof(double)};
  }
  struct Hash {
    const SharedVectors& vectors;
    std::size_t operator()(int place) const {
      return std::hash<std::string_view>()(vectors.bytes(place));
    }
  };
  struct Equal {
    const SharedVectors& vectors;
    bool operator()(int a, int b) const { return vectors.bytes(a) == vectors.bytes(b); }
  };

  std::vector<double> numbers_;
  std::unordered_set<int, Hash, Equal> places_{16, Hash{*this}, Equal{*this}};
};

}  // namespace qddot::kernels
