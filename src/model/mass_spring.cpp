#include "qddot/model/mass_spring.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "qddot/model/block_pattern.hpp"
#include "qddot/model/directions.hpp"
#include "qddot/model/in_tension.hpp"
#include "qddot/model/kernels/springs_by_node.hpp"
#include "qddot/model/kernels/stiffness_kernel.hpp"
#include "qddot/model/kinks.hpp"
#include "qddot/model/layout.hpp"
#include "qddot/model/network_halves.hpp"
#include "qddot/model/nodal_loads.hpp"

namespace qddot {
namespace {

using namespace kernels;

// Measured: from so many nodes on vectors sum forces faster than a loop over springs does.
constexpr Index fewest_for_vectors = 16;

// Springs between nodes all of whose coordinates are unknowns are kept apart, by their first
// unknowns alone; the few that touch a node on a mirror go through the layout.
template <int D>
class MassSpring final : public System,
                         public SplitStiffness,
                         public DiscreteGradient,
                         public Laplacian,
                         public PiecewiseLinear,
                         public Validity,
                         public Kinks,
                         public SplitForces {
  using Point = Eigen::Matrix<double, D, 1>;
  using Block = Eigen::Matrix<double, D, D>;

  // i, j: first unknowns. Of an image link, j may be i.
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
  // i, j: nodes.
  struct EdgeLink {
    int i, j, place;
    Point mirror;
    SpringLaw law;
  };

 public:
  MassSpring(const Network& network, Forces forces)
      : MassSpring(network, forces, {network.node_mass.size(), network.zero_coordinates}) {}

  double potential(const Vec& q) const override {
    double v = constant_energy_ - weight_.dot(q);
    for_all(q, [&](const SpringLaw& law, const Point& d) { v += spring_energy(law, d); });
    return v;
  }

  void force(const Vec& q, Vec& f) const override {
    if (by_node_) return by_node_->sum_forces(q, weight_, f);
    sum_forces(
        [&](const auto& spring) { return spring_force(spring.law, between(q, spring)); },
        [&](const auto& spring) { return spring_force(spring.law, edge_between(q, spring)); }, f);
  }

  void discrete_gradient(const Vec& a, const Vec& b, Vec& f) const override {
    sum_forces(
        [&](const auto& spring) {
          return spring_discrete_gradient(spring.law, between(a, spring), between(b, spring));
        },
        [&](const auto& spring) {
          return spring_discrete_gradient(spring.law, edge_between(a, spring),
                                          edge_between(b, spring));
        },
        f);
  }

  void stiffness(const Vec& q, SymmetricMatrix& k) const override { weighted_stiffness(q, 1, k); }

  void weighted_stiffness(const Vec& q, double compression_weight,
                          SymmetricMatrix& k) const override {
    const auto block = [compression_weight](const SpringLaw& law, const Point& d) {
      return spring_stiffness(law, d, compression_weight);
    };
    if (!by_node_) return assemble(q, k, block);
    columns_->stiffness(*by_node_, q, compression_weight, k);
    add_left_out(q, k, block);
  }

  void material_stiffness(const Vec& q, SymmetricMatrix& k) const override {
    const auto block = [](const SpringLaw& law, const Point& d) {
      return spring_material_stiffness(law, d);
    };
    if (!by_node_) return assemble(q, k, block);
    columns_->material_stiffness(*by_node_, q, k);
    add_left_out(q, k, block);
  }

  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  bool stiffness_is_constant() const override { return linear_; }
  bool offers(const std::type_info& type) const override {
    if (type == typeid(PiecewiseLinear)) return linear_ && keeps_directions();
    if (type == typeid(Validity)) return !in_tension_.empty();
    if (type == typeid(Kinks)) return kinks_ > 0;
    if (type == typeid(SplitForces)) return split_.has_value();
    return true;
  }

  bool is_linear_at(const Vec& q) const override {
    const signed char* direction = directions_.data();
    bool all = true;
    for_all(q, [&](const SpringLaw&, const Point& d) {
      const int own = *direction++;
      all = all & (own == 0 || own * d[0] > 0);
    });
    return all;
  }
  const Split& split() const override { return *split_; }

  bool bounds_stiffness() const override { return !has_quartic_; }
  // The network at rest lengths zero is stiff alike at every q.
  void laplacian(SymmetricMatrix& l) const override {
    assemble(Vec::Zero(size()), l, [](const SpringLaw& law, const Point&) -> Block {
      return -law.stiffness * Block::Identity();
    });
  }

  // Elsewhere than on a line hardly a motion meets a length of zero.
  Index kinks() const override { return kinks_; }
  void kink_lengths(const Vec& q, Vec& lengths) const override {
    Index i = 0;
    for_all(q, [&](const SpringLaw& law, const Point& d) {
      if (turns_over(law)) lengths[i++] = d[0];
    });
  }

  bool is_valid_at(const Vec& q) const override { return in_tension_.holds_at(layout_, q); }
  std::optional<double> end_of_validity(const State& from, const State& to) const override {
    return in_tension_.first_slack(layout_, mass(), from, to);
  }

 private:
  MassSpring(const Network& network, Forces forces, const Layout<D>& layout)
      : System(masses(network, layout)),
        layout_(layout),
        weight_(weights(network, layout)),
        constant_energy_(network.constant_energy) {
    BlockPattern<D> pattern(layout_);
    for (const auto& link : network.links) pattern.join(link.i, link.j);
    for (const auto& link : network.image_links) pattern.join(link.i, link.j);
    pattern_ = pattern.make();
    for (const auto& [i, j, law, holds, stiff, direction] : network.links) {
      take_link({i, j, pattern.place(i, j), Point::Ones(), law}, holds, true);
    }
    for (const auto& [i, j, mirror, law, holds, stiff, direction] : network.image_links) {
      const Point signs = Eigen::Map<const Point>(mirror.data());
      take_link({i, j, pattern.place(i, j), signs, law}, holds, false);
    }
    for (const auto& [i, place, law, holds, stiff, direction] : network.anchors) {
      take_anchor({i, Eigen::Map<const Point>(place.data()), law}, holds);
    }
    directions_ = directions(network, layout_);
    if (forces == Forces::by_vectors ||
        (forces == Forces::whichever_is_faster && layout_.nodes() >= fewest_for_vectors)) {
      by_node_.emplace(network, layout_);
      columns_.emplace(network, layout_, *by_node_, pattern_);
    }
    linear_ = network.uses_constant_stiffness;
    const Vec anywhere = Vec::Zero(size());
    for_all(anywhere, [&](const SpringLaw& law, const Point&) {
      linear_ &= law.is_linear() || keeps_directions();
      if (law.quartic > 0) has_quartic_ = true;
      kinks_ += turns_over(law);
    });
    if (network.offers_split) {
      const Network stiff = only(network, true);
      const std::vector<int> nodes = pulled_nodes(stiff);
      split_ = {std::make_shared<MassSpring>(stiff, forces),
                std::make_shared<MassSpring>(only(network, false), forces),
                std::make_shared<MassSpring>(among(nodes, stiff), forces),
                {}};
      for (const int i : nodes) {
        for (int a = 0; a < layout.count(i); ++a) {
          split_->stiff_unknowns.push_back(layout.first(i) + a);
        }
      }
    }
  }

  bool keeps_directions() const { return !directions_.empty(); }
  bool turns_over(const SpringLaw& law) const {
    return D == 1 && law.rest_length > 0 && !keeps_directions();
  }

  void take_link(const EdgeLink& link, Holds holds, bool is_plain) {
    if (holds == Holds::in_tension) in_tension_.add({link.i, link.j, link.mirror, link.law});
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
  void take_anchor(const Anchor& anchor, Holds holds) {
    if (holds == Holds::in_tension) in_tension_.add({anchor.i, -1, anchor.point, anchor.law});
    if (layout_.is_full(anchor.i)) {
      anchors_.push_back({layout_.first(anchor.i), anchor.point, anchor.law});
    } else {
      edge_anchors_.push_back(anchor);
    }
  }

  // f = constant force and, of every spring, on_i(spring) on its node i and the opposite on j; of
  // springs that go through the layout, edge_on_i(spring).
  template <class OnI, class EdgeOnI>
  [[gnu::always_inline]] void sum_forces(const OnI& on_i, const EdgeOnI& edge_on_i, Vec& f) const {
    f = weight_;
    for (const Link& link : links_) {
      const Point force = on_i(link);
      f.segment<D>(link.i) += force;
      f.segment<D>(link.j) -= force;
    }
    for (const Image& image : images_) {
      const Point force = on_i(image);
      f.segment<D>(image.i) += force;
      f.segment<D>(image.j) -= image.mirror.cwiseProduct(force);
    }
    for (const Anchor& anchor : anchors_) f.segment<D>(anchor.i) += on_i(anchor);
    for (const EdgeLink& link : edge_links_) {
      const Point force = edge_on_i(link);
      layout_.add(force, link.i, f);
      layout_.add(-link.mirror.cwiseProduct(force), link.j, f);
    }
    for (const Anchor& anchor : edge_anchors_) layout_.add(edge_on_i(anchor), anchor.i, f);
  }

  // With S = diag(mirror) and d = S x_j - x_i: K_ii -= B, K_jj -= S B S, K_ij += B S; where i = j
  // all three are one block.
  template <class BlockOf>
  void assemble(const Vec& q, SymmetricMatrix& k, const BlockOf& block) const {
    k.coeffs().setZero();
    add_own_blocks(q, k, block);
    for (std::size_t e = 0; e < links_.size(); ++e) add_link_block(q, k, block, e);
    add_image_blocks(q, k, block);
  }

  // What the columns leave out.
  template <class BlockOf>
  void add_left_out(const Vec& q, SymmetricMatrix& k, const BlockOf& block) const {
    for (const int e : columns_->links_left_out()) add_link_block(q, k, block, e);
    add_image_blocks(q, k, block);
  }

  template <class BlockOf>
  void add_own_blocks(const Vec& q, SymmetricMatrix& k, const BlockOf& block) const {
    for (const Link& link : links_) {
      const Block b = block(link.law, between(q, link));
      subtract_from_diagonal(k, link.i, b);
      subtract_from_diagonal(k, link.j, b);
    }
    for (const Image& image : images_) {
      const Block b = block(image.law, between(q, image));
      subtract_from_diagonal(k, image.i, b);
      subtract_from_diagonal(k, image.j, image.mirror.asDiagonal() * b * image.mirror.asDiagonal());
    }
    for (const Anchor& anchor : anchors_) {
      subtract_from_diagonal(k, anchor.i, block(anchor.law, between(q, anchor)));
    }
    for (const EdgeLink& link : edge_links_) {
      const Block b = block(link.law, edge_between(q, link));
      edge_subtract_from_diagonal(k, link.i, b);
      edge_subtract_from_diagonal(k, link.j,
                                  link.mirror.asDiagonal() * b * link.mirror.asDiagonal());
    }
    for (const Anchor& anchor : edge_anchors_) {
      edge_subtract_from_diagonal(k, anchor.i, block(anchor.law, edge_between(q, anchor)));
    }
  }

  template <class BlockOf>
  void add_link_block(const Vec& q, SymmetricMatrix& k, const BlockOf& block, std::size_t e) const {
    const Link& link = links_[e];
    add_below_diagonal(k, std::min(link.i, link.j), link_places_[e],
                       block(link.law, between(q, link)));
  }

  // Adds the blocks of images and of links whose nodes have fewer unknowns.
  template <class BlockOf>
  void add_image_blocks(const Vec& q, SymmetricMatrix& k, const BlockOf& block) const {
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
      const Block b = block(link.law, edge_between(q, link));
      const Block bs = b * link.mirror.asDiagonal(), sb = link.mirror.asDiagonal() * b;
      if (link.i == link.j) {
        edge_subtract_from_diagonal(k, link.i, -(bs + sb));
      } else {
        edge_add_below_diagonal(k, link, link.i > link.j ? bs : sb);
      }
    }
  }

  // Calls action(law, d) for every spring.
  template <class Action>
  void for_all(const Vec& q, const Action& action) const {
    for (const Link& link : links_) action(link.law, between(q, link));
    for (const Image& image : images_) action(image.law, between(q, image));
    for (const Anchor& anchor : anchors_) action(anchor.law, between(q, anchor));
    for (const EdgeLink& link : edge_links_) action(link.law, edge_between(q, link));
    for (const Anchor& anchor : edge_anchors_) action(anchor.law, edge_between(q, anchor));
  }

  static Point between(const Vec& q, const Link& link) {
    return q.segment<D>(link.j) - q.segment<D>(link.i);
  }
  static Point between(const Vec& q, const Image& image) {
    return image.mirror.cwiseProduct(q.segment<D>(image.j)) - q.segment<D>(image.i);
  }
  static Point between(const Vec& q, const Anchor& anchor) {
    return anchor.point - q.segment<D>(anchor.i);
  }
  Point edge_between(const Vec& q, const EdgeLink& link) const {
    return link.mirror.cwiseProduct(layout_.at(q, link.j)) - layout_.at(q, link.i);
  }
  Point edge_between(const Vec& q, const Anchor& anchor) const {
    return anchor.point - layout_.at(q, anchor.i);
  }

  // For a node whose first unknown is `first` and whose D coordinates are all unknowns.
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
  // For a node with fewer.
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

  Layout<D> layout_;
  std::vector<Link> links_;
  std::vector<Image> images_;
  std::vector<Anchor> anchors_;
  std::vector<int> link_places_, image_places_;  // as in EdgeLink
  std::vector<EdgeLink> edge_links_;             // with an end that has fewer unknowns
  std::vector<Anchor> edge_anchors_;             // likewise, by nodes
  InTension<D> in_tension_;                      // once more, those that hold in tension only
  Vec weight_;                                   // M g + load [N]
  std::vector<signed char> directions_;  // of all springs in the order of for_all; empty where none
  double constant_energy_;
  bool linear_ = false;
  Index kinks_ = 0;
  bool has_quartic_ = false;
  SymmetricMatrix pattern_;
  std::optional<SpringsByNode<D>> by_node_;
  std::optional<StiffnessKernel<D>> columns_;
  std::optional<Split> split_;
};

}  // namespace

std::unique_ptr<System> make_mass_spring(const Network& network, Forces forces) {
  if (network.dimension == 1) return std::make_unique<MassSpring<1>>(network, forces);
  if (network.dimension == 2) return std::make_unique<MassSpring<2>>(network, forces);
  if (network.dimension == 3) return std::make_unique<MassSpring<3>>(network, forces);
  throw std::invalid_argument("a network has 1, 2 or 3 dimensions");
}

}  // namespace qddot
