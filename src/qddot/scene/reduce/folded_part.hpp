#pragma once

#include <vector>

#include <Eigen/Core>

#include "qddot/scene/reduce/drawn_part.hpp"
#include "qddot/scene/reduce/mirror.hpp"
#include "qddot/scene/reduce/signs.hpp"

namespace qddot::reduce {

// A node of a part as the image diag(signs) y of an original: itself, or another node of its orbit
// under the group of all mirrors (see orbits.hpp). The original lies on the side of each mirror
// where its coordinate is not negative; of coincident nodes, it is the first.
struct ImageOf {
  int original;
  Signs signs;
};

// The nodes of a part folded along its mirrors.
struct FoldedNodes {
  std::vector<Eigen::Vector3d> y;        // positions of all nodes in the mirrors' frame
  std::vector<ImageOf> images;           // of all nodes
  std::vector<unsigned char> on_planes;  // of all nodes, a bit for each coordinate that stays zero
};

// Folds the nodes of a part along its mirrors.
FoldedNodes folded(const DrawnPart& drawn, const Mirrors& mirrors);

// The ends of a spring between originals: at y_a and at diag(mirror) y_b.
struct FoldedEnds {
  int a, b;
  Signs mirror;

  // Whether both are one node for ever.
  bool coincide() const { return a == b && mirror.are_all_plus(); }
};

// A spring between originals.
struct FoldedSpring {
  FoldedEnds ends;
  SpringLaw law;
  Holds holds;
  bool stiff;
  int first;  // the part's number of the first of those that it stands for
};

// The springs of a part folded along its mirrors. One stands for each set of images, with the sum
// of their stiffnesses, at the place of the shortest. A spring that would join a node to itself is
// left out: without a rest length (see mirrors_of) it has no force.
class FoldedSprings {
 public:
  // Keeps references to both.
  FoldedSprings(const DrawnPart& drawn, const FoldedNodes& half, const Mirrors& mirrors);

  // Calls see(FoldedSpring) for each, in the order of the part's springs.
  template <class See>
  void for_each(const See& see) const {
    constexpr int ahead = 32;
    for (int e = 0; e < drawn_.springs.size(); ++e) {
      if (e + ahead < std::ssize(next_) && next(e + ahead) != none)
        drawn_.springs.prefetch(next(e + ahead));
      if (next_.empty() || !is_in_other_[static_cast<std::size_t>(e)]) see(sum_at(e));
    }
  }
  std::size_t count() const { return count_; }
  // The part's numbers of all that a spring stands for.
  std::vector<int> images_of(const FoldedSpring& spring) const {
    std::vector<int> all = {spring.first};
    while (!next_.empty() && next(all.back()) != none) all.push_back(next(all.back()));
    return all;
  }

 private:
  FoldedEnds ends(int e) const {
    const auto [from, to] = drawn_.springs.ends(e);
    const ImageOf a = half_.images[static_cast<std::size_t>(from)],
                  b = half_.images[static_cast<std::size_t>(to)];
    // A sign of a coordinate that is zero at one end changes no length.
    const unsigned zero = half_.on_planes[static_cast<std::size_t>(a.original)] |
                          half_.on_planes[static_cast<std::size_t>(b.original)];
    return {a.original, b.original, a.signs.times(b.signs).without(zero)};
  }
  // The spring that begins a sum, with all that it stands for.
  FoldedSpring sum_at(int e) const {
    const auto [drawn_ends, law, holds, stiff] = drawn_.springs[e];
    FoldedSpring sum{ends(e), law, holds, stiff, e};
    if (next_.empty()) return sum;
    for (int more = next(e); more != none; more = next(more)) {
      const PartSprings::One other = drawn_.springs[more];
      sum.law.stiffness += other.law.stiffness;
      sum.law.quartic += other.law.quartic;
      sum.law.damping += other.law.damping;
      sum.stiff = sum.stiff || other.stiff;
    }
    return sum;
  }
  int next(int e) const { return next_[static_cast<std::size_t>(e)]; }
  void chain_images(double tolerance);

  static constexpr int none = -1;

  const DrawnPart& drawn_;
  const FoldedNodes& half_;
  // Empty without mirrors. Of each spring: the next one of the same sum, or none; and whether it is
  // in the sum of another, or left out.
  std::vector<int> next_;
  std::vector<bool> is_in_other_;
  std::size_t count_ = 0;
};

}  // namespace qddot::reduce
