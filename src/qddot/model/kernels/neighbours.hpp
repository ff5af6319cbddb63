#pragma once

#include <array>
#include <cstring>
#include <numeric>
#include <vector>

#include "qddot/model/spring.hpp"

namespace qddot::kernels {

// One end of a spring as seen from its node: the other end, and the number of its law.
struct Neighbour {
  int point;  // a node, or an extra point; see slice_neighbours
  int law;
};

// The neighbours of all nodes: those of node i are ends[first[i]], ..., ends[first[i + 1] - 1], in
// the order in which they were seen.
struct Neighbours {
  std::vector<int> first;  // of each node, and the end
  std::vector<Neighbour> ends;
  std::vector<SpringLaw> laws;

  int nodes() const { return static_cast<int>(first.size()) - 1; }
  int count(int node) const { return first[node + 1] - first[node]; }
};

// A product with this spreads the bits of a number over the first ones (Knuth, The Art of Computer
// Programming 3, 6.4).
constexpr unsigned long hash_factor = 0x9e3779b97f4a7c15;

// Numbers laws. A law seen shortly before has the same number again, so that a grid has few.
class LawNumbers {
 public:
  explicit LawNumbers(std::vector<SpringLaw>& laws) : laws_(laws) { recent_.fill(-1); }

  int number(const SpringLaw& law) {
    std::array<unsigned long, 3> bits;
    static_assert(sizeof bits == sizeof law);
    std::memcpy(&bits, &law, sizeof bits);
    int& recent = recent_[((bits[0] ^ bits[1] * 3 ^ bits[2] * 5) * hash_factor) >> (64 - 6)];
    // By their bytes: zeros of both signs are different laws.
    if (recent < 0 || std::memcmp(&laws_[recent], &law, sizeof law) != 0) {
      recent = static_cast<int>(laws_.size());
      laws_.push_back(law);
    }
    return recent;
  }

 private:
  std::vector<SpringLaw>& laws_;
  std::array<int, 64> recent_;
};

// Sorts ends of springs by their nodes, by counting. for_each_end(see) calls see(node, point, law)
// for all ends, twice in the same order.
template <class ForEachEnd>
Neighbours neighbours_of(int nodes, const ForEachEnd& for_each_end) {
  Neighbours result;
  result.first.assign(nodes + 1, 0);
  for_each_end([&](int node, int, const SpringLaw&) { ++result.first[node + 1]; });
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.ends.resize(result.first.back());
  std::vector<int> next(result.first.begin(), result.first.end() - 1);
  LawNumbers numbers(result.laws);
  for_each_end([&](int node, int point, const SpringLaw& law) {
    result.ends[next[node]++] = {point, numbers.number(law)};
  });
  return result;
}

}  // namespace qddot::kernels
