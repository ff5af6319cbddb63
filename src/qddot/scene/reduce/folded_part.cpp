#include "qddot/scene/reduce/folded_part.hpp"

#include <algorithm>
#include <cstdint>

#include "qddot/model/grouped.hpp"
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

std::vector<ImageOf> images_of(const Orbits& orbits, int mirrors, const FoldedNodes& half) {
  std::vector<ImageOf> images(half.y.size());
  for (int i = 0; i < std::ssize(images); ++i) {
    if (original_of(i, orbits, mirrors, half.y) != i) continue;
    const unsigned zero = half.on_planes[static_cast<std::size_t>(i)];
    for (unsigned g = 0; g < orbits.elements(); ++g) {
      // Zero is its own image.
      images[static_cast<std::size_t>(orbits.image(g, i))] = {
          i, Signs{static_cast<unsigned char>(g)}.without(zero)};
    }
  }
  return images;
}

}  // namespace

FoldedNodes folded(const DrawnPart& drawn, const Mirrors& mirrors) {
  FoldedNodes half;
  const Orbits orbits(mirrors.images);
  half.y.reserve(drawn.nodes.size());
  half.on_planes.reserve(drawn.nodes.size());
  for (std::size_t i = 0; i < drawn.nodes.size(); ++i) {
    half.y.push_back(mirrors.frame.point(drawn.x[i]));
    const unsigned zero = orbits.zero_coordinates(static_cast<int>(i));
    for (int d = 0; d < mirrors.count; ++d) {
      if (zero >> d & 1) half.y[i][d] = 0;
    }
    half.on_planes.push_back(static_cast<unsigned char>(zero));
  }
  half.images = images_of(orbits, mirrors.count, half);
  return half;
}

FoldedSprings::FoldedSprings(const DrawnPart& drawn, const FoldedNodes& half,
                             const Mirrors& mirrors)
    : drawn_(drawn), half_(half), count_(static_cast<std::size_t>(drawn.springs.size())) {
  if (mirrors.count > 0) chain_images(rounding * largest_coordinate(drawn.x));
}

// Springs with the same ends, images and length may be added. They are found among those with the
// same lower end.
void FoldedSprings::chain_images(double tolerance) {
  const auto springs = static_cast<std::size_t>(drawn_.springs.size());
  next_.assign(springs, none);
  is_in_other_.assign(springs, false);
  const Grouped by_low(static_cast<int>(half_.y.size()), drawn_.springs.size(), [&](int e) {
    const auto [a, b] = drawn_.springs.ends(e);
    return std::min(half_.images[static_cast<std::size_t>(a)].original,
                    half_.images[static_cast<std::size_t>(b)].original);
  });
  struct Image {
    std::uint64_t kind;  // the higher end, mirror, validity and whether it is a rod
    double rest_length;
    int e;
    bool operator<(const Image& other) const {
      if (kind != other.kind) return kind < other.kind;
      return rest_length != other.rest_length ? rest_length < other.rest_length : e < other.e;
    }
  };
  constexpr int ahead = 8;
  std::vector<Image> images;
  for (int low = 0; low < by_low.groups(); ++low) {
    images.clear();
    if (low + ahead < by_low.groups()) {
      for (const int e : by_low[low + ahead]) drawn_.springs.prefetch(e);
    }
    for (const int e : by_low[low]) {
      const FoldedEnds own = ends(e);
      if (own.coincide()) {
        is_in_other_[static_cast<std::size_t>(e)] = true;
        --count_;
      } else {
        const PartSprings::One spring = drawn_.springs[e];
        const auto high = static_cast<std::uint64_t>(std::max(own.a, own.b));
        const auto holds = static_cast<std::uint64_t>(spring.holds);
        const std::uint64_t kind = high << 16 | std::uint64_t{own.mirror.minus} << 8 | holds << 1 |
                                   (spring.law.rigid ? 1 : 0);
        images.push_back({kind, spring.law.rest_length, e});
      }
    }
    std::ranges::sort(images, std::less<>());
    for (std::size_t i = 1, first = 0; i < images.size(); ++i) {
      if (images[i].kind != images[first].kind ||
          images[i].rest_length - images[first].rest_length > tolerance) {
        first = i;
        continue;
      }
      next_[static_cast<std::size_t>(images[i - 1].e)] = images[i].e;
      is_in_other_[static_cast<std::size_t>(images[i].e)] = true;
      --count_;
    }
  }
}

}  // namespace qddot::reduce
