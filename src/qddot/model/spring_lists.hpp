#pragma once

#include <algorithm>
#include <vector>

#include "qddot/model/block_pattern.hpp"
#include "qddot/model/layout.hpp"
#include "qddot/model/mass_spring.hpp"
#include "qddot/model/spring.hpp"

namespace qddot {

// The springs of a network in lists, and the sums over them that give force and stiffness. Most
// springs join nodes whose coordinates are all unknowns; they store the first unknowns of their
// ends. The few others use the layout.
template <int D>
class SpringLists {
 public:
  using Point = Eigen::Matrix<double, D, 1>;
  using Block = Eigen::Matrix<double, D, D>;

  // i, j: first unknowns; j may be i for an image link.
  struct Link {
    int i, j;
    SpringLaw law;
  };
  struct Image {
    int i, j;
    Point mirror;
    SpringLaw law;
  };
  struct Anchor {
    int i;
    Point point;
    SpringLaw law;
  };
  // i, j: nodes; place: as BlockPattern has it.
  struct EdgeLink {
    int i, j, place;
    Point mirror;
    SpringLaw law;
  };
  struct EdgeAnchor {
    int i;
    Point point;
    SpringLaw law;
  };

  // Keeps a reference to the layout, which must outlive it.
  SpringLists(const Network& network, const Layout<D>& layout) : layout_(layout) {
    BlockPattern<D> pattern(layout_);
    for (const auto& link : network.links) pattern.join(link.i, link.j);
    for (const auto& link : network.image_links) pattern.join(link.i, link.j);
    pattern_ = pattern.make();
    for (const auto& link : network.links) {
      take({link.i, link.j, pattern.place(link.i, link.j), Point::Ones(), link.law}, true);
    }
    for (const auto& link : network.image_links) {
      const Point mirror = Eigen::Map<const Point>(link.mirror.data());
      take({link.i, link.j, pattern.place(link.i, link.j), mirror, link.law}, false);
    }
    for (const auto& anchor : network.anchors) {
      const Point point = Eigen::Map<const Point>(anchor.point.data());
      if (layout_.is_full(anchor.i)) {
        anchors_.push_back({layout_.first(anchor.i), point, anchor.law});
      } else {
        edge_anchors_.push_back({anchor.i, point, anchor.law});
      }
    }
  }

  // The pattern of K.
  const SymmetricMatrix& pattern() const { return pattern_; }

  // Calls see(spring) for each spring, list by list.
  template <class See>
  [[gnu::always_inline]] void for_each(const See& see) const {
    for (const Link& link : links_) see(link);
    for (const Image& image : images_) see(image);
    for (const Anchor& anchor : anchors_) see(anchor);
    for (const EdgeLink& link : edge_links_) see(link);
    for (const EdgeAnchor& anchor : edge_anchors_) see(anchor);
  }

  // The same for springs to fixed points only.
  template <class See>
  [[gnu::always_inline]] void for_each_anchor(const See& see) const {
    for (const Anchor& anchor : anchors_) see(anchor);
    for (const EdgeAnchor& anchor : edge_anchors_) see(anchor);
  }

  // d from a spring's end i to its end j: diag(mirror) x_j - x_i or point - x_i.
  Point between(const VecView& q, const Link& link) const {
    return q.segment<D>(link.j) - q.segment<D>(link.i);
  }
  Point between(const VecView& q, const Image& image) const {
    return image.mirror.cwiseProduct(q.segment<D>(image.j)) - q.segment<D>(image.i);
  }
  Point between(const VecView& q, const Anchor& anchor) const {
    return anchor.point - q.segment<D>(anchor.i);
  }
  Point between(const VecView& q, const EdgeLink& link) const {
    return link.mirror.cwiseProduct(layout_.at(q, link.j)) - layout_.at(q, link.i);
  }
  Point between(const VecView& q, const EdgeAnchor& anchor) const {
    return anchor.point - layout_.at(q, anchor.i);
  }

  // Adds each spring's force on_i(spring) to its end i in f, and the opposite force to its end j.
  template <class OnI>
  [[gnu::always_inline]] void add_forces(const OnI& on_i, MutableVec f) const {
    for_each([&](const auto& spring)
                 __attribute__((always_inline)) { add_force(spring, on_i(spring), f); });
  }

  // Sets K to the sum over all springs of B = block(law, d), with S = diag(mirror): K_ii -= B,
  // K_jj -= S B S, K_ij += B S. If i = j, all three are one block.
  template <class BlockOf>
  void assemble(const VecView& q, SymmetricMatrix& k, const BlockOf& block) const {
    k.coeffs().setZero();
    for_each([&](const auto& spring) {
      subtract_own_blocks(spring, block(spring.law, between(q, spring)), k);
    });
    for (std::size_t e = 0; e < links_.size(); ++e) add_link_block(q, k, block, e);
    add_image_blocks(q, k, block);
  }

  // Adds the off-diagonal block of link number e.
  template <class BlockOf>
  void add_link_block(const VecView& q, SymmetricMatrix& k, const BlockOf& block,
                      std::size_t e) const {
    const Link& link = links_[e];
    add_below_diagonal(k, std::min(link.i, link.j), link_places_[e],
                       block(link.law, between(q, link)));
  }

  // Adds the off-diagonal blocks of images and of links whose nodes have fewer unknowns.
  template <class BlockOf>
  void add_image_blocks(const VecView& q, SymmetricMatrix& k, const BlockOf& block) const {
    for (std::size_t e = 0; e < images_.size(); ++e) {
      const auto& [i, j, mirror, law] = images_[e];
      const Block b = block(law, between(q, images_[e]));
      const Block bs = b * mirror.asDiagonal(), sb = mirror.asDiagonal() * b;
      if (i == j) {
        subtract_from_diagonal(k, i, -(bs + sb));
      } else {
        // The block's rows belong to the later node.
        add_below_diagonal(k, std::min(i, j), image_places_[e], i > j ? bs : sb);
      }
    }
    for (const EdgeLink& link : edge_links_) {
      const Block b = block(link.law, between(q, link));
      const Block bs = b * link.mirror.asDiagonal(), sb = link.mirror.asDiagonal() * b;
      if (link.i == link.j) {
        edge_subtract_from_diagonal(k, link.i, -(bs + sb));
      } else {
        edge_add_below_diagonal(k, link, link.i > link.j ? bs : sb);
      }
    }
  }

 private:
  void take(const EdgeLink& link, bool is_plain) {
    if (!layout_.is_full(link.i) || !layout_.is_full(link.j)) {
      edge_links_.push_back(link);
    } else if (is_plain) {
      links_.push_back({layout_.first(link.i), layout_.first(link.j), link.law});
      link_places_.push_back(link.place);
    } else {
      images_.push_back({layout_.first(link.i), layout_.first(link.j), link.mirror, link.law});
      image_places_.push_back(link.place);
    }
  }

  static void add_force(const Link& link, const Point& force, MutableVec f) {
    f.segment<D>(link.i) += force;
    f.segment<D>(link.j) -= force;
  }
  static void add_force(const Image& image, const Point& force, MutableVec f) {
    f.segment<D>(image.i) += force;
    f.segment<D>(image.j) -= image.mirror.cwiseProduct(force);
  }
  static void add_force(const Anchor& anchor, const Point& force, MutableVec f) {
    f.segment<D>(anchor.i) += force;
  }
  void add_force(const EdgeLink& link, const Point& force, MutableVec f) const {
    layout_.add(force, link.i, f);
    layout_.add(-link.mirror.cwiseProduct(force), link.j, f);
  }
  void add_force(const EdgeAnchor& anchor, const Point& force, MutableVec f) const {
    layout_.add(force, anchor.i, f);
  }

  static void subtract_own_blocks(const Link& link, const Block& b, SymmetricMatrix& k) {
    subtract_from_diagonal(k, link.i, b);
    subtract_from_diagonal(k, link.j, b);
  }
  static void subtract_own_blocks(const Image& image, const Block& b, SymmetricMatrix& k) {
    subtract_from_diagonal(k, image.i, b);
    subtract_from_diagonal(k, image.j, image.mirror.asDiagonal() * b * image.mirror.asDiagonal());
  }
  static void subtract_own_blocks(const Anchor& anchor, const Block& b, SymmetricMatrix& k) {
    subtract_from_diagonal(k, anchor.i, b);
  }
  void subtract_own_blocks(const EdgeLink& link, const Block& b, SymmetricMatrix& k) const {
    edge_subtract_from_diagonal(k, link.i, b);
    edge_subtract_from_diagonal(k, link.j, link.mirror.asDiagonal() * b * link.mirror.asDiagonal());
  }
  void subtract_own_blocks(const EdgeAnchor& anchor, const Block& b, SymmetricMatrix& k) const {
    edge_subtract_from_diagonal(k, anchor.i, b);
  }

  // `first`: the first unknown of a node whose D coordinates are all unknowns.
  static void subtract_from_diagonal(SymmetricMatrix& k, int first, const Block& b) {
    for (int d = 0; d < D; ++d) {
      double* column = k.valuePtr() + k.outerIndexPtr()[first + d];
      for (int row = d; row < D; ++row) column[row - d] -= b(row, d);
    }
  }
  static void add_below_diagonal(SymmetricMatrix& k, int first, int place, const Block& b) {
    for (int d = 0; d < D; ++d) {
      double* column = k.valuePtr() + k.outerIndexPtr()[first + d] + (D - d) + place;
      for (int row = 0; row < D; ++row) column[row] += b(row, d);
    }
  }
  // The same for a node with fewer unknowns.
  void edge_subtract_from_diagonal(SymmetricMatrix& k, int node, const Block& b) const {
    const int count = layout_.count(node);
    for (int c = 0; c < count; ++c) {
      double* column = k.valuePtr() + k.outerIndexPtr()[layout_.first(node) + c];
      for (int r = c; r < count; ++r) {
        column[r - c] -= b(layout_.axis(node, r), layout_.axis(node, c));
      }
    }
  }
  void edge_add_below_diagonal(SymmetricMatrix& k, const EdgeLink& link, const Block& b) const {
    const int node = std::min(link.i, link.j), below = std::max(link.i, link.j);
    const int columns = layout_.count(node), rows = layout_.count(below);
    for (int c = 0; c < columns; ++c) {
      double* column =
          k.valuePtr() + k.outerIndexPtr()[layout_.first(node) + c] + (columns - c) + link.place;
      for (int r = 0; r < rows; ++r) column[r] += b(layout_.axis(below, r), layout_.axis(node, c));
    }
  }

  const Layout<D>& layout_;
  SymmetricMatrix pattern_;
  std::vector<Link> links_;
  std::vector<Image> images_;
  std::vector<Anchor> anchors_;
  std::vector<int> link_places_, image_places_;  // as in EdgeLink
  std::vector<EdgeLink> edge_links_;             // with an end that has fewer unknowns
  std::vector<EdgeAnchor> edge_anchors_;
};

}  // namespace qddot
