#include "experiments/advice/own_pairs.hpp"

#include "qddot/model/differenced_stiffness.hpp"

namespace qddot::judged_advice {
namespace {

class Pairs : public System {
 public:
  Pairs(Vec mass, int dimension, std::vector<OwnPair> pairs, bool computes_energy)
      : System(std::move(mass)),
        dimension_(dimension),
        pairs_(std::move(pairs)),
        computes_energy_(computes_energy) {}

  bool has_potential() const override { return computes_energy_; }

  double potential(const At& at) const override {
    double sum = 0;
    for (const OwnPair& pair : pairs_) sum += pair.law.at(between(pair, at.q).norm()).energy;
    return sum;
  }
  void force(const At& at, MutableVec f) const override {
    f.setZero();
    for (const OwnPair& pair : pairs_) {
      const Vec d = between(pair, at.q);
      const Vec pull = d * (pair.law.at(d.norm()).tension / d.norm());
      f.segment(first(pair.one), dimension_) += pull;
      if (pair.other) f.segment(first(*pair.other), dimension_) -= pull;
    }
  }

 protected:
  Index first(std::size_t node) const { return static_cast<Index>(node) * dimension_; }
  Vec between(const OwnPair& pair, const ConstVec& q) const {
    Vec d = -q.segment(first(pair.one), dimension_);
    if (pair.other) d += q.segment(first(*pair.other), dimension_);
    return d;
  }

  int dimension_;
  std::vector<OwnPair> pairs_;
  bool computes_energy_;
};

// With a K of its own, as a full matrix.
class StiffPairs final : public Pairs {
 public:
  StiffPairs(Vec mass, int dimension, std::vector<OwnPair> pairs, bool computes_energy)
      : Pairs(std::move(mass), dimension, std::move(pairs), computes_energy) {
    const Eigen::MatrixXd all = Eigen::MatrixXd::Ones(size(), size());
    pattern_ = Eigen::MatrixXd(all.triangularView<Eigen::Lower>()).sparseView();
    pattern_.coeffs().setZero();
  }
  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  void stiffness(const At& at, SymmetricMatrix& k) const override {
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(size(), size());
    for (const OwnPair& pair : pairs_) {
      const Vec d = between(pair, at.q);
      const double r = d.norm();
      const auto law = pair.law.at(r);
      const Eigen::MatrixXd nn = d * d.transpose() / (r * r);
      const Eigen::MatrixXd b =
          law.tangent * nn +
          law.tension / r * (Eigen::MatrixXd::Identity(dimension_, dimension_) - nn);
      const Index i = first(pair.one);
      full.block(i, i, dimension_, dimension_) -= b;
      if (!pair.other) continue;
      const Index j = first(*pair.other);
      full.block(j, j, dimension_, dimension_) -= b;
      full.block(i, j, dimension_, dimension_) += b;
      full.block(j, i, dimension_, dimension_) += b;
    }
    for (Index c = 0; c < size(); ++c) {
      for (SymmetricMatrix::InnerIterator entry(k, c); entry; ++entry)
        entry.valueRef() = full(entry.row(), c);
    }
  }

 private:
  SymmetricMatrix pattern_;
};

}  // namespace

std::shared_ptr<const System> system_of_pairs(const std::vector<Node>& nodes, int dimension,
                                              const std::vector<OwnPair>& pairs,
                                              bool computes_stiffness, bool computes_energy) {
  Vec mass(static_cast<Index>(nodes.size()) * dimension);
  for (Index i = 0; i < mass.size(); ++i)
    mass[i] = nodes[static_cast<std::size_t>(i / dimension)].mass;
  if (computes_stiffness)
    return std::make_shared<const StiffPairs>(std::move(mass), dimension, pairs, computes_energy);
  std::vector<std::pair<Index, Index>> all;
  for (Index i = 0; i < mass.size(); ++i) {
    for (Index j = 0; j < i; ++j) all.push_back({i, j});
  }
  return std::make_shared<const DifferencedStiffness>(
      std::make_shared<const Pairs>(std::move(mass), dimension, pairs, computes_energy), all);
}

}  // namespace qddot::judged_advice
