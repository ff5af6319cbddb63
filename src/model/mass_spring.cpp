#include "src/model/mass_spring.hpp"

#include <algorithm>
#include <stdexcept>

namespace qddot {
namespace {

template <int D>
class MassSpring final : public System {
  using Point = Eigen::Matrix<double, D, 1>;
  using Block = Eigen::Matrix<double, D, D>;

 public:
  explicit MassSpring(const Network& network)
      : System(network.node_mass.replicate(1, D).transpose().reshaped()),
        links_(network.links),
        anchors_(network.anchors),
        weight_(mass().cwiseProduct(network.gravity.head<D>().replicate(nodes(), 1))),
        constant_energy_(network.constant_energy) {
    const auto linear = [](const auto& spring) { return spring.law.is_linear(); };
    linear_ = std::ranges::all_of(links_, linear) && std::ranges::all_of(anchors_, linear);
    make_pattern();
  }

  double potential(const Vec& q) const override {
    double v = constant_energy_ - weight_.dot(q);
    for (const auto& link : links_) v += spring_energy(link.law, between(q, link));
    for (const auto& anchor : anchors_) v += spring_energy(anchor.law, between(q, anchor));
    return v;
  }

  void force(const Vec& q, Vec& f) const override {
    f = weight_;
    for (const auto& link : links_) {
      const Point on_i = spring_force(link.law, between(q, link));
      f.segment<D>(D * link.i) += on_i;
      f.segment<D>(D * link.j) -= on_i;
    }
    for (const auto& anchor : anchors_) {
      f.segment<D>(D * anchor.i) += spring_force(anchor.law, between(q, anchor));
    }
  }

  void stiffness(const Vec& q, SymmetricMatrix& k) const override {
    k.coeffs().setZero();
    for (std::size_t e = 0; e < links_.size(); ++e) {
      const auto& link = links_[e];
      const Block b = spring_stiffness(link.law, between(q, link));
      subtract_from_diagonal(k, link.i, b);
      subtract_from_diagonal(k, link.j, b);
      add_below_diagonal(k, std::min(link.i, link.j), place_[e], b);
    }
    for (const auto& anchor : anchors_) {
      subtract_from_diagonal(k, anchor.i, spring_stiffness(anchor.law, between(q, anchor)));
    }
  }

  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  bool stiffness_is_constant() const override { return linear_; }

 private:
  Index nodes() const { return size() / D; }

  static Point between(const Vec& q, const Network::Link& link) {
    return q.segment<D>(D * link.j) - q.segment<D>(D * link.i);
  }
  static Point between(const Vec& q, const Network::Anchor& anchor) {
    return anchor.point.head<D>() - q.segment<D>(D * anchor.i);
  }

  // Column c = D j + d of the lower triangle holds the rows d ... D-1 of node j's own block, then
  // D rows for each neighbour i > j in ascending order. So a block is found by its node's first
  // column and its place among the neighbours: nothing is searched for during assembly.
  static void subtract_from_diagonal(SymmetricMatrix& k, int node, const Block& b) {
    for (int d = 0; d < D; ++d) {
      double* column = k.valuePtr() + k.outerIndexPtr()[D * node + d];
      for (int row = d; row < D; ++row) column[row - d] -= b(row, d);
    }
  }
  static void add_below_diagonal(SymmetricMatrix& k, int node, int place, const Block& b) {
    for (int d = 0; d < D; ++d) {
      double* column = k.valuePtr() + k.outerIndexPtr()[D * node + d] + (D - d) + D * place;
      for (int row = 0; row < D; ++row) column[row] += b(row, d);
    }
  }

  void make_pattern() {
    std::vector<std::vector<int>> below(nodes());  // the neighbours i > j of each node j
    for (const auto& [i, j, law] : links_) below[std::min(i, j)].push_back(std::max(i, j));
    Index nonzeros = 0;
    for (auto& list : below) {
      std::ranges::sort(list);
      list.erase(std::ranges::unique(list).begin(), list.end());
      nonzeros += D * (D + 1) / 2 + D * D * std::ssize(list);
    }
    pattern_.resize(size(), size());
    pattern_.reserve(nonzeros);
    for (int column = 0; column < size(); ++column) {
      const int node = column / D;
      pattern_.startVec(column);
      for (int row = column; row < D * (node + 1); ++row) pattern_.insertBack(row, column) = 0;
      for (const int i : below[node]) {
        for (int row = D * i; row < D * (i + 1); ++row) pattern_.insertBack(row, column) = 0;
      }
    }
    pattern_.finalize();
    for (const auto& [i, j, law] : links_) {
      const auto& list = below[std::min(i, j)];
      place_.push_back(
          static_cast<int>(std::ranges::lower_bound(list, std::max(i, j)) - list.begin()));
    }
  }

  std::vector<Network::Link> links_;
  std::vector<Network::Anchor> anchors_;
  Vec weight_;  // M g [N]
  double constant_energy_;
  bool linear_;
  SymmetricMatrix pattern_;
  std::vector<int> place_;  // of each link's block among its lower node's neighbours
};

}  // namespace

std::unique_ptr<System> make_mass_spring(const Network& network) {
  switch (network.dimension) {
    case 1:
      return std::make_unique<MassSpring<1>>(network);
    case 2:
      return std::make_unique<MassSpring<2>>(network);
    case 3:
      return std::make_unique<MassSpring<3>>(network);
    default:
      throw std::invalid_argument("a network has 1, 2 or 3 dimensions");
  }
}

}  // namespace qddot
