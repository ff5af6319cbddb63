#pragma once

#include <optional>
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

// A spring between originals: it ends at y_a and at diag(mirror) y_b.
struct FoldedSpring {
  int a, b;
  Signs mirror;
  SpringLaw law;
  Holds holds;
  bool stiff;
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
    for (int e = 0; e < drawn_.springs.size(); ++e) {
      if (const std::optional<FoldedSpring> sum = sum_at(e)) see(*sum);
    }
  }
  std::size_t count() const { return count_; }

 private:
  std::optional<FoldedSpring> sum_at(int e) const;
  FoldedSpring at(int e) const;
  void chain_images(double tolerance);

  const DrawnPart& drawn_;
  const FoldedNodes& half_;
  // Empty without mirrors. Of each spring: the next one of the same sum, or -1; and whether it is
  // in the sum of another, or left out.
  std::vector<int> next_;
  std::vector<bool> is_part_of_sum_;
  std::size_t count_ = 0;
};

}  // namespace qddot::reduce
