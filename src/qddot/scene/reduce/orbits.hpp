#pragma once

#include <vector>

namespace qddot::reduce {

// Reflections as permutations of a part's nodes. Each is its own inverse and all commute, so the
// group that they generate acts on the nodes. An element of the group is a set of reflections, a
// bit for each. The orbit of a node is the set of its images under all elements.
class Orbits {
 public:
  // `images`: of each node under each reflection; must outlive this.
  explicit Orbits(const std::vector<std::vector<int>>& images) : images_(images) {}

  unsigned elements() const { return 1u << images_.size(); }
  // The image of a node under an element.
  int image(unsigned element, int node) const {
    for (std::size_t d = 0; d < images_.size(); ++d) {
      if (element >> d & 1) node = images_[d][static_cast<std::size_t>(node)];
    }
    return node;
  }
  // Whether the same elements leave both nodes in place.
  bool are_fixed_alike(int a, int b) const {
    for (unsigned g = 1; g < elements(); ++g) {
      if ((image(g, a) == a) != (image(g, b) == b)) return false;
    }
    return true;
  }
  // The reflections in all elements that leave the node where it is. An element is diag(+-1, ...)
  // of the coordinates, so those with these bits are zero.
  unsigned zero_coordinates(int node) const {
    unsigned zero = 0;
    for (unsigned g = 1; g < elements(); ++g) {
      if (image(g, node) == node) zero |= g;
    }
    return zero;
  }

 private:
  const std::vector<std::vector<int>>& images_;
};

}  // namespace qddot::reduce
