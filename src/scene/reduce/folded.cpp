#include "src/scene/reduce/folded.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace qddot {
namespace {

using Eigen::Vector3d;

// The image of node i on the positive side of each mirror; of two on the same side, the first.
ImageOf image_of(std::size_t i, const Mirrors& mirrors, const std::vector<Vector3d>& y) {
  ImageOf image{i, Vector3d::Ones()};
  for (int d = 0; d < mirrors.count; ++d) {
    const std::size_t here = image.original;
    const auto there = static_cast<std::size_t>(mirrors.images[d][here]);
    if (std::pair(-y[there][d], there) < std::pair(-y[here][d], here)) {
      image = {there, image.signs};
      image.signs[d] = -1;
    }
  }
  return image;
}

// Which springs may be added: those between the same ends in the same way, of the same length.
auto ends(const Folded::Spring& spring) {
  const auto [low, high] = std::minmax(spring.a, spring.b);
  return std::tuple(low, high, spring.mirror[0], spring.mirror[1], spring.mirror[2], spring.holds);
}

// One spring for each set of images, as stiff as all of them, at the place of the first.
std::vector<Folded::Spring> summed(const std::vector<Folded::Spring>& springs, double tolerance) {
  std::vector<std::size_t> order(springs.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t e) {
    return std::tuple(ends(springs[e]), springs[e].law.rest_length);
  });
  std::vector<Folded::Spring> sums = springs;
  std::vector<bool> is_summed(springs.size(), false);
  for (std::size_t i = 1, first = 0; i < order.size(); ++i) {
    Folded::Spring& sum = sums[order[first]];
    const Folded::Spring& next = springs[order[i]];
    if (ends(next) != ends(sum) || next.law.rest_length - sum.law.rest_length > tolerance) {
      first = i;
      continue;
    }
    sum.law.stiffness += next.law.stiffness;
    sum.law.quartic += next.law.quartic;
    sum.stiff = sum.stiff || next.stiff;
    is_summed[order[i]] = true;
  }
  std::vector<Folded::Spring> left;
  for (std::size_t e = 0; e < sums.size(); ++e) {
    if (!is_summed[e]) left.push_back(sums[e]);
  }
  return left;
}

}  // namespace

Folded folded(const Body& body, const Mirrors& mirrors) {
  Folded result;
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    result.y.push_back(mirrors.frame.point(body.x[i]));
    result.w.push_back(mirrors.frame.direction(body.v[i]));
    unsigned planes = 0;
    for (int d = 0; d < mirrors.count; ++d) {
      if (mirrors.images[d][i] != static_cast<int>(i)) continue;
      planes |= 1u << d;
      result.y[i][d] = result.w[i][d] = 0;
    }
    result.on_planes.push_back(planes);
  }
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    result.images.push_back(image_of(i, mirrors, result.y));
  }
  result.springs.reserve(body.springs.size());
  for (const qddot::Spring& spring : body.springs) {
    const ImageOf &a = result.images[spring.nodes[0]], &b = result.images[spring.nodes[1]];
    Folded::Spring image{a.original, b.original,   a.signs.cwiseProduct(b.signs),
                         spring.law, spring.holds, spring.stiff};
    // The image of a node on a plane is that node.
    const unsigned planes = result.on_planes[a.original] | result.on_planes[b.original];
    for (int d = 0; d < mirrors.count; ++d) {
      if (planes >> d & 1) image.mirror[d] = 1;
    }
    result.springs.push_back(image);
  }
  if (mirrors.count > 0) {
    result.springs = summed(result.springs, rounding * largest_coordinate(body.x));
  }
  return result;
}

}  // namespace qddot
