#include "qddot/scene/reduce/folded_part.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "qddot/scene/reduce/orbits.hpp"

namespace qddot::reduce {
namespace {

using Eigen::Vector3d;

// The node of i's orbit that represents the whole orbit.
int original_of(int i, const Orbits& orbits, int mirrors, const std::vector<Vector3d>& y) {
  const auto rank = [&](int node) {
    const Vector3d& at = y[static_cast<std::size_t>(node)];
    unsigned behind = 0;  // the first mirror is the most significant
    for (int d = 0; d < mirrors; ++d) behind = 2 * behind + (at[d] < 0 ? 1 : 0);
    return std::pair(behind, node);
  };
  int best = i;
  for (unsigned g = 1; g < orbits.elements(); ++g) {
    const int other = orbits.image(g, i);
    if (rank(other) < rank(best)) best = other;
  }
  return best;
}

std::vector<ImageOf> images_of(const Orbits& orbits, int mirrors, const FoldedPart& half) {
  std::vector<ImageOf> images(half.y.size());
  for (int i = 0; i < std::ssize(images); ++i) {
    if (original_of(i, orbits, mirrors, half.y) != i) continue;
    const unsigned zero = half.on_planes[static_cast<std::size_t>(i)];
    for (unsigned g = 0; g < orbits.elements(); ++g) {
      // Zero is its own image.
      Vector3d signs = Vector3d::Ones();
      for (int d = 0; d < mirrors; ++d) {
        if ((g & ~zero) >> d & 1) signs[d] = -1;
      }
      images[static_cast<std::size_t>(orbits.image(g, i))] = {static_cast<std::size_t>(i), signs};
    }
  }
  return images;
}

// Springs with equal keys may be added: they have the same ends, images and length.
auto ends(const FoldedPart::Spring& spring) {
  const auto [low, high] = std::minmax(spring.a, spring.b);
  return std::tuple(low, high, spring.mirror[0], spring.mirror[1], spring.mirror[2], spring.holds);
}

// One spring for each set of images, with the sum of their stiffnesses, at the place of the first.
std::vector<FoldedPart::Spring> summed(const std::vector<FoldedPart::Spring>& springs,
                                       double tolerance) {
  std::vector<std::size_t> order(springs.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t e) {
    return std::tuple(ends(springs[e]), springs[e].law.rest_length);
  });
  std::vector<FoldedPart::Spring> sums = springs;
  std::vector<bool> is_summed(springs.size(), false);
  for (std::size_t i = 1, first = 0; i < order.size(); ++i) {
    FoldedPart::Spring& sum = sums[order[first]];
    const FoldedPart::Spring& next = springs[order[i]];
    if (ends(next) != ends(sum) || next.law.rest_length - sum.law.rest_length > tolerance) {
      first = i;
      continue;
    }
    sum.law.stiffness += next.law.stiffness;
    sum.law.quartic += next.law.quartic;
    sum.stiff = sum.stiff || next.stiff;
    is_summed[order[i]] = true;
  }
  std::vector<FoldedPart::Spring> left;
  for (std::size_t e = 0; e < sums.size(); ++e) {
    if (!is_summed[e]) left.push_back(sums[e]);
  }
  return left;
}

}  // namespace

FoldedPart folded(const DrawnPart& drawn, const Mirrors& mirrors) {
  FoldedPart result;
  const Orbits orbits(mirrors.images);
  for (std::size_t i = 0; i < drawn.nodes.size(); ++i) {
    result.y.push_back(mirrors.frame.point(drawn.x[i]));
    result.w.push_back(mirrors.frame.direction(drawn.v[i]));
    const unsigned zero = orbits.zero_coordinates(static_cast<int>(i));
    for (int d = 0; d < mirrors.count; ++d) {
      if (zero >> d & 1) result.y[i][d] = result.w[i][d] = 0;
    }
    result.on_planes.push_back(zero);
  }
  result.images = images_of(orbits, mirrors.count, result);
  result.springs.reserve(drawn.springs.size());
  for (const qddot::Spring& spring : drawn.springs) {
    const ImageOf &a = result.images[spring.nodes[0]], &b = result.images[spring.nodes[1]];
    FoldedPart::Spring image{a.original, b.original,   a.signs.cwiseProduct(b.signs),
                             spring.law, spring.holds, spring.stiff};
    // A sign of a coordinate that is zero at one end changes no length.
    const unsigned zero = result.on_planes[a.original] | result.on_planes[b.original];
    for (int d = 0; d < mirrors.count; ++d) {
      if (zero >> d & 1) image.mirror[d] = 1;
    }
    // Both ends are one node forever: without a rest length (see mirrors_of) the spring has no
    // force.
    if (image.a == image.b && image.mirror == Vector3d::Ones()) continue;
    result.springs.push_back(image);
  }
  if (mirrors.count > 0) {
    result.springs = summed(result.springs, rounding * largest_coordinate(drawn.x));
  }
  return result;
}

}  // namespace qddot::reduce
