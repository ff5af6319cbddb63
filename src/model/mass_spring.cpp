#include "src/model/mass_spring.hpp"

#include <algorithm>
#include <stdexcept>

#include "src/model/layout.hpp"

namespace qddot {
namespace {

// `per_node` of each node, laid out as the unknowns are.
template <int D, class Layout, class PerNode>
Vec unknowns_from(const Layout& layout, const PerNode& per_node) {
  Vec all(layout.first(static_cast<int>(layout.nodes())));
  for (int i = 0; i < layout.nodes(); ++i) {
    const Eigen::Matrix<double, D, 1> x = per_node(i);
    for (int a = 0; a < layout.count(i); ++a) all[layout.first(i) + a] = x[layout.axis(i, a)];
  }
  return all;
}

template <int D, class Layout>
class MassSpring final : public System {
  using Point = Eigen::Matrix<double, D, 1>;
  using Block = Eigen::Matrix<double, D, D>;

  // An ImageLink with the diagonal of its mirror.
  struct Image {
    int i, j;
    Point mirror;
    SpringLaw law;
  };

 public:
  MassSpring(const Network& network, const Layout& layout)
      : System(unknowns_from<D>(
            layout, [&](int i) -> Point { return Point::Constant(network.node_mass[i]); })),
        layout_(layout),
        links_(network.links),
        anchors_(network.anchors),
        weight_(unknowns_from<D>(layout,
                                 [&](int i) -> Point {
                                   const Point g = network.gravity.head<D>();
                                   const Point mg = network.node_mass[i] * g;
                                   if (network.load.size() == 0) return mg;
                                   return mg + network.load.segment<D>(D * i);
                                 })),
        constant_energy_(network.constant_energy) {
    for (const Network::ImageLink& image : network.image_links) {
      images_.push_back({image.i, image.j, image.mirror.head<D>(), image.law});
    }
    const auto linear = [](const auto& spring) { return spring.law.is_linear(); };
    linear_ = network.uses_constant_stiffness && std::ranges::all_of(links_, linear) &&
              std::ranges::all_of(images_, linear) && std::ranges::all_of(anchors_, linear);
    const auto needs_tension = [](const auto& spring) { return spring.law.holds_in_tension_only; };
    needs_tension_ = std::ranges::any_of(links_, needs_tension) ||
                     std::ranges::any_of(images_, needs_tension) ||
                     std::ranges::any_of(anchors_, needs_tension);
    make_pattern();
  }

  double potential(const Vec& q) const override {
    double v = constant_energy_ - weight_.dot(q);
    for_all_springs(
        [&](const auto& spring) { v += spring_energy(spring.law, between(q, spring)); });
    return v;
  }

  void force(const Vec& q, Vec& f) const override {
    f = weight_;
    for (const auto& link : links_) {
      const Point on_i = spring_force(link.law, between(q, link));
      layout_.add(on_i, link.i, f);
      layout_.subtract(on_i, link.j, f);
    }
    for (const auto& image : images_) {
      const Point on_i = spring_force(image.law, between(q, image));
      layout_.add(on_i, image.i, f);
      layout_.subtract(image.mirror.cwiseProduct(on_i), image.j, f);
    }
    for (const auto& anchor : anchors_) {
      layout_.add(spring_force(anchor.law, between(q, anchor)), anchor.i, f);
    }
  }

  void stiffness(const Vec& q, SymmetricMatrix& k) const override {
    k.coeffs().setZero();
    for (std::size_t e = 0; e < links_.size(); ++e) {
      const auto& link = links_[e];
      const Block b = spring_stiffness(link.law, between(q, link));
      subtract_from_diagonal(k, link.i, b);
      subtract_from_diagonal(k, link.j, b);
      add_below_diagonal(k, std::min(link.i, link.j), std::max(link.i, link.j), place_[e], b);
    }
    // With S = diag(mirror) and d = S x_j - x_i: K_ii -= B, K_jj -= S B S, K_ij += B S.
    for (std::size_t e = 0; e < images_.size(); ++e) {
      const auto& [i, j, mirror, law] = images_[e];
      const Block b = spring_stiffness(law, between(q, images_[e]));
      const Block bs = b * mirror.asDiagonal(), sb = mirror.asDiagonal() * b;
      subtract_from_diagonal(k, i, b);
      subtract_from_diagonal(k, j, sb * mirror.asDiagonal());
      if (i == j) {
        subtract_from_diagonal(k, i, -(bs + sb));
      } else {
        // The block's rows belong to the later node.
        add_below_diagonal(k, std::min(i, j), std::max(i, j), place_[links_.size() + e],
                           i > j ? bs : sb);
      }
    }
    for (const auto& anchor : anchors_) {
      subtract_from_diagonal(k, anchor.i, spring_stiffness(anchor.law, between(q, anchor)));
    }
  }

  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  bool stiffness_is_constant() const override { return linear_; }

  bool holds_at(const Vec& q) const override {
    if (!needs_tension_) return true;
    bool holds = true;
    for_all_springs([&](const auto& spring) {
      // A spring drawn at its rest length may be shorter by what rounding makes of it.
      holds = holds && (!spring.law.holds_in_tension_only ||
                        between(q, spring).norm() >= (1 - 1e-12) * spring.law.rest_length);
    });
    return holds;
  }

 private:
  Index nodes() const { return layout_.nodes(); }

  template <class Action>
  void for_all_springs(const Action& action) const {
    for (const auto& link : links_) action(link);
    for (const auto& image : images_) action(image);
    for (const auto& anchor : anchors_) action(anchor);
  }

  Point between(const Vec& q, const Network::Link& link) const {
    return layout_.at(q, link.j) - layout_.at(q, link.i);
  }
  Point between(const Vec& q, const Image& image) const {
    return image.mirror.cwiseProduct(layout_.at(q, image.j)) - layout_.at(q, image.i);
  }
  Point between(const Vec& q, const Network::Anchor& anchor) const {
    return anchor.point.head<D>() - layout_.at(q, anchor.i);
  }

  // The column of node j's coordinate a holds the rows a, a + 1, ... of its own block, then the
  // rows of each neighbour i > j in ascending order. So a block is found by its node's first column
  // and its place below it: nothing is searched for during assembly.
  void subtract_from_diagonal(SymmetricMatrix& k, int node, const Block& b) const {
    const int count = layout_.count(node);
    for (int c = 0; c < count; ++c) {
      double* column = k.valuePtr() + k.outerIndexPtr()[layout_.first(node) + c];
      for (int r = c; r < count; ++r) {
        column[r - c] -= b(layout_.axis(node, r), layout_.axis(node, c));
      }
    }
  }
  void add_below_diagonal(SymmetricMatrix& k, int node, int below, int place,
                          const Block& b) const {
    const int columns = layout_.count(node), rows = layout_.count(below);
    for (int c = 0; c < columns; ++c) {
      double* column =
          k.valuePtr() + k.outerIndexPtr()[layout_.first(node) + c] + (columns - c) + place;
      for (int r = 0; r < rows; ++r) {
        column[r] += b(layout_.axis(below, r), layout_.axis(node, c));
      }
    }
  }

  void make_pattern() {
    std::vector<std::vector<int>> below(nodes());  // the neighbours i > j of each node j
    const auto join = [&](int i, int j) {
      if (i != j) below[std::min(i, j)].push_back(std::max(i, j));
    };
    for (const auto& link : links_) join(link.i, link.j);
    for (const auto& image : images_) join(image.i, image.j);
    Index nonzeros = 0;
    for (auto& list : below) {
      std::ranges::sort(list);
      list.erase(std::ranges::unique(list).begin(), list.end());
      nonzeros += D * (D + 1) / 2 + D * D * std::ssize(list);
    }
    pattern_.resize(size(), size());
    pattern_.reserve(nonzeros);
    for (int node = 0; node < nodes(); ++node) {
      const Index end = layout_.first(node + 1);
      for (Index column = layout_.first(node); column < end; ++column) {
        pattern_.startVec(column);
        for (Index row = column; row < end; ++row) pattern_.insertBack(row, column) = 0;
        for (const int i : below[node]) {
          for (Index row = layout_.first(i); row < layout_.first(i + 1); ++row) {
            pattern_.insertBack(row, column) = 0;
          }
        }
      }
    }
    pattern_.finalize();
    std::vector<std::vector<int>> rows_before(nodes());  // of each neighbour, in its node's columns
    for (int node = 0; node < nodes(); ++node) {
      int rows = 0;
      for (const int i : below[node]) {
        rows_before[node].push_back(rows);
        rows += layout_.count(i);
      }
    }
    const auto place = [&](int i, int j) {
      const auto& list = below[std::min(i, j)];
      if (i == j) return 0;  // on the diagonal, where no place is needed
      return rows_before[std::min(i, j)][static_cast<std::size_t>(
          std::ranges::lower_bound(list, std::max(i, j)) - list.begin())];
    };
    for (const auto& link : links_) place_.push_back(place(link.i, link.j));
    for (const auto& image : images_) place_.push_back(place(image.i, image.j));
  }

  Layout layout_;
  std::vector<Network::Link> links_;
  std::vector<Image> images_;
  std::vector<Network::Anchor> anchors_;
  Vec weight_;  // M g + load [N]
  double constant_energy_;
  bool linear_, needs_tension_;
  SymmetricMatrix pattern_;
  std::vector<int> place_;  // rows between its lower node's own block and each link's block
};

template <int D>
std::unique_ptr<System> make(const Network& network) {
  if (network.zero_coordinates.empty()) {
    const FullLayout<D> layout(network.node_mass.size());
    return std::make_unique<MassSpring<D, FullLayout<D>>>(network, layout);
  }
  const PartialLayout<D> layout(network.zero_coordinates);
  return std::make_unique<MassSpring<D, PartialLayout<D>>>(network, layout);
}

}  // namespace

std::unique_ptr<System> make_mass_spring(const Network& network) {
  switch (network.dimension) {
    case 1:
      return make<1>(network);
    case 2:
      return make<2>(network);
    case 3:
      return make<3>(network);
    default:
      throw std::invalid_argument("a network has 1, 2 or 3 dimensions");
  }
}

}  // namespace qddot
