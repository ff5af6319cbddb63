#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "qddot/model/system.hpp"

namespace qddot::inline measure {

// The relative error of an invariant at time t [s]. The sample stands for the part `weight` of the
// run, in any unit.
struct Sample {
  double t = 0, error = 0, weight = 1;
};

// Means over blocks of equal duration from the time `begin` on; no block is empty.
struct Blocks {
  Vec means;                     // empty if there are too few samples
  double begin = 0, length = 0;  // [s]

  Index count() const { return means.size(); }
  double middle() const { return begin + static_cast<double>(count()) / 2 * length; }
  Index block_of(double t) const {
    return std::clamp<Index>(static_cast<Index>((t - begin) / length), 0, count() - 1);
  }
};

constexpr Index most_blocks = 64, least_blocks = 4;
// Each block has at least so many samples, unless there are too few.
constexpr std::ptrdiff_t samples_a_block = 4;

// The means of value(sample) over as many blocks as the samples allow, at most `most_blocks`.
template <class Value>
Blocks in_blocks(std::span<const Sample> samples, double begin, const Value& value) {
  if (samples.empty()) return {};
  const double end = samples.back().t;
  const Index all = std::ssize(samples);
  Index count = std::clamp(all / samples_a_block, std::min(all, least_blocks), most_blocks);
  for (; count >= least_blocks; count /= 2) {
    Blocks blocks{Vec::Zero(count), begin, (end - begin) / static_cast<double>(count)};
    Vec weights = Vec::Zero(count);
    for (const Sample& sample : samples) {
      const Index block = blocks.block_of(sample.t);
      blocks.means[block] += sample.weight * value(sample);
      weights[block] += sample.weight;
    }
    if ((weights.array() <= 0).any()) continue;
    blocks.means.array() /= weights.array();
    return blocks;
  }
  return {};
}

// The range of the means over eighths of the blocks: slow changes, with little noise.
inline double slow_range(const Blocks& blocks) {
  constexpr Index parts = 8;
  const Index n = blocks.count();
  if (n < parts) return n > 0 ? blocks.means.maxCoeff() - blocks.means.minCoeff() : 0;
  double low = INFINITY, high = -INFINITY;
  for (Index k = 0; k < parts; ++k) {
    const Index first = n * k / parts, next = n * (k + 1) / parts;
    const double mean = blocks.means.segment(first, next - first).mean();
    low = std::min(low, mean);
    high = std::max(high, mean);
  }
  return high - low;
}

}  // namespace qddot::inline measure
