#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "qddot/model/block_pattern.hpp"
#include "qddot/model/layout.hpp"
#include "qddot/model/mass_spring.hpp"
#include "qddot/model/spring_lists.hpp"

namespace qddot {

// The pattern of a network's K, with the place of each spring's blocks in it, and the sums over the
// springs that give K.
template <int D>
class StiffnessBlocks {
 public:
  using Lists = SpringLists<D>;
  using Moved = typename Lists::Moved;
  using Link = typename Lists::Link;
  using Image = typename Lists::Image;
  using Anchor = typename Lists::Anchor;
  using EdgeLink = typename Lists::EdgeLink;
  using EdgeAnchor = typename Lists::EdgeAnchor;
  using General = typename Lists::General;
  using Block = Eigen::Matrix<double, D, D>;

  // `springs` are those of the network. Keeps references to them and to the layout, which must
  // outlive it.
  StiffnessBlocks(const Network& network, const Layout<D>& layout, const Lists& springs)
      : layout_(layout), springs_(springs) {
    const BlockPattern<D> pattern(network, layout_);
    pattern_ = pattern.make();
    const auto place_all = [&](const auto& links, std::vector<int>& places) {
      for (const auto& link : links) {
        const bool is_full = layout_.is_full(link.i) && layout_.is_full(link.j);
        (is_full ? places : edge_places_).push_back(pattern.place(link.i, link.j));
      }
    };
    link_places_.reserve(network.links.size());
    place_all(network.links, link_places_);
    place_all(network.image_links, image_places_);
    for (const auto& spring : network.general) {
      general_places_[{spring.i, spring.j}] = spring.j < 0 ? 0 : pattern.place(spring.i, spring.j);
    }
  }

  const SymmetricMatrix& pattern() const { return pattern_; }

  // Sets K to the sum over all springs of B = block(law, d), with S = diag(mirror): K_ii -= B,
  // K_jj -= S B S, K_ij += B S. If i = j, all three are one block.
  template <class BlockOf>
  void assemble(const Moved& q, SymmetricMatrix& k, const BlockOf& block) const {
    k.coeffs().setZero();
    springs_.for_each(q.phases, [&](const auto& spring) {
      subtract_own_blocks(spring, block(spring.law, springs_.between(q, spring)), k);
    });
    for (std::size_t e = 0; e < springs_.links().size(); ++e) add_link_block(q, k, block, e);
    add_image_blocks(q, k, block);
    springs_.for_each_general(
        q.phases, [&](const General& spring) { add_general_block(q, k, block, spring); });
  }
  // Adds to K that of the springs which are not plain.
  template <class BlockOf>
  void add_general(const Moved& q, SymmetricMatrix& k, const BlockOf& block) const {
    springs_.for_each_general(q.phases, [&](const General& spring) {
      subtract_own_blocks(spring, block(spring.law, springs_.between(q, spring)), k);
      add_general_block(q, k, block, spring);
    });
  }

  // Adds the off-diagonal block of link number e.
  template <class BlockOf>
  void add_link_block(const Moved& q, SymmetricMatrix& k, const BlockOf& block,
                      std::size_t e) const {
    const Link& link = springs_.links()[e];
    add_below_diagonal(k, std::min(link.i, link.j), link_places_[e],
                       block(link.law, springs_.between(q, link)));
  }

  // Adds the off-diagonal blocks of images and of links whose nodes have fewer unknowns.
  template <class BlockOf>
  void add_image_blocks(const Moved& q, SymmetricMatrix& k, const BlockOf& block) const {
    for (std::size_t e = 0; e < springs_.images().size(); ++e) {
      const Image& image = springs_.images()[e];
      const auto& [i, j, mirror, law] = image;
      const Block b = block(law, springs_.between(q, image));
      const Block bs = b * mirror.asDiagonal(), sb = mirror.asDiagonal() * b;
      if (i == j) {
        subtract_from_diagonal(k, i, -(bs + sb));
      } else {
        // The block's rows belong to the later node.
        add_below_diagonal(k, std::min(i, j), image_places_[e], i > j ? bs : sb);
      }
    }
    for (std::size_t e = 0; e < springs_.edge_links().size(); ++e) {
      const EdgeLink& link = springs_.edge_links()[e];
      const Block b = block(link.law, springs_.between(q, link));
      const Block bs = b * link.mirror.asDiagonal(), sb = link.mirror.asDiagonal() * b;
      if (link.i == link.j) {
        edge_subtract_from_diagonal(k, link.i, -(bs + sb));
      } else {
        edge_add_below_diagonal(k, link, edge_places_[e], link.i > link.j ? bs : sb);
      }
    }
  }

 private:
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

  void subtract_own_blocks(const General& spring, const Block& b, SymmetricMatrix& k) const {
    edge_subtract_from_diagonal(k, spring.i, b);
    if (spring.j >= 0) edge_subtract_from_diagonal(k, spring.j, b);
  }
  template <class BlockOf>
  void add_general_block(const Moved& q, SymmetricMatrix& k, const BlockOf& block,
                         const General& spring) const {
    if (spring.j < 0) return;
    edge_add_below_diagonal(k, spring, general_places_.at({spring.i, spring.j}),
                            block(spring.law, springs_.between(q, spring)));
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
  template <class Ends>
  void edge_add_below_diagonal(SymmetricMatrix& k, const Ends& link, int place,
                               const Block& b) const {
    const int node = std::min(link.i, link.j), below = std::max(link.i, link.j);
    const int columns = layout_.count(node), rows = layout_.count(below);
    for (int c = 0; c < columns; ++c) {
      double* column =
          k.valuePtr() + k.outerIndexPtr()[layout_.first(node) + c] + (columns - c) + place;
      for (int r = 0; r < rows; ++r) column[r] += b(layout_.axis(below, r), layout_.axis(node, c));
    }
  }

  const Layout<D>& layout_;
  const Lists& springs_;
  SymmetricMatrix pattern_;
  std::vector<int> link_places_, image_places_, edge_places_;  // as BlockPattern has them
  std::map<std::pair<int, int>, int> general_places_;          // of i and j
};

}  // namespace qddot
