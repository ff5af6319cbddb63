#include "qddot/model/block_diagonal_system.hpp"

#include <algorithm>
#include <stdexcept>

namespace qddot {
namespace {

Vec all_masses(const std::vector<std::unique_ptr<System>>& blocks) {
  Index n = 0;
  for (const auto& block : blocks) n += block->size();
  Vec mass(n);
  Index at = 0;
  for (const auto& block : blocks) {
    mass.segment(at, block->size()) = block->mass();
    at += block->size();
  }
  return mass;
}

// Calls action(block, its segment of q, the segment's start) for each block.
template <class Action>
void for_each(const std::vector<std::unique_ptr<System>>& blocks, const ConstVec& q,
              const Action& action) {
  Index at = 0;
  for (const auto& block : blocks) {
    action(*block, ConstVec(q.segment(at, block->size())), at);
    at += block->size();
  }
}

template <class C>
bool all_offer(const std::vector<std::unique_ptr<System>>& blocks) {
  return std::ranges::all_of(blocks,
                             [](const auto& block) { return capability<C>(*block) != nullptr; });
}
template <class C>
bool any_offers(const std::vector<std::unique_ptr<System>>& blocks) {
  return std::ranges::any_of(blocks,
                             [](const auto& block) { return capability<C>(*block) != nullptr; });
}

}  // namespace

BlockDiagonalSystem::BlockDiagonalSystem(std::vector<std::unique_ptr<System>> blocks)
    : CapableSystem(all_masses(blocks)), blocks_(std::move(blocks)) {
  const auto has_stiffness = [](const auto& block) { return block->has_stiffness(); };
  if (!std::ranges::all_of(blocks_, has_stiffness)) return;
  pattern_.resize(size(), size());
  Index nonzeros = 0;
  for (const auto& block : blocks_) nonzeros += block->stiffness_pattern().nonZeros();
  pattern_.reserve(nonzeros);
  Index at = 0;
  for (const auto& block : blocks_) {
    const SymmetricMatrix& own = block->stiffness_pattern();
    for (Index column = 0; column < own.cols(); ++column) {
      pattern_.startVec(at + column);
      for (SymmetricMatrix::InnerIterator entry(own, column); entry; ++entry) {
        pattern_.insertBack(at + entry.row(), at + column) = 0;
      }
    }
    at += block->size();
  }
  pattern_.finalize();
}

bool BlockDiagonalSystem::offers(const std::type_info& type) const {
  if (type == typeid(SplitStiffness)) return all_offer<SplitStiffness>(blocks_);
  if (type == typeid(DiscreteGradient)) return all_offer<DiscreteGradient>(blocks_);
  if (type == typeid(Laplacian)) return all_offer<Laplacian>(blocks_);
  if (type == typeid(PiecewiseLinear)) return any_offers<PiecewiseLinear>(blocks_);
  if (type == typeid(Validity)) return any_offers<Validity>(blocks_);
  if (type == typeid(Kinks)) return any_offers<Kinks>(blocks_);
  return true;
}

bool BlockDiagonalSystem::has_potential() const {
  return std::ranges::all_of(blocks_, [](const auto& block) { return block->has_potential(); });
}

double BlockDiagonalSystem::potential(const ConstVec& q) const {
  double v = 0;
  for_each(blocks_, q,
           [&](const System& block, const ConstVec& own, Index) { v += block.potential(own); });
  return v;
}

void BlockDiagonalSystem::force(const ConstVec& q, MutableVec f) const {
  for_each(blocks_, q, [&](const System& block, const ConstVec& own, Index at) {
    block.force(own, f.segment(at, block.size()));
  });
}

void BlockDiagonalSystem::discrete_gradient(const ConstVec& a, const ConstVec& b,
                                            MutableVec f) const {
  for_each(blocks_, a, [&](const System& block, const ConstVec& own, Index at) {
    const Index n = block.size();
    capability<DiscreteGradient>(block)->discrete_gradient(own, b.segment(at, n), f.segment(at, n));
  });
}

template <class Evaluate>
void BlockDiagonalSystem::assemble(const ConstVec& q, SymmetricMatrix& k,
                                   const Evaluate& evaluate) const {
  Index next = 0;
  for_each(blocks_, q, [&](const System& block, const ConstVec& own, Index) {
    SymmetricMatrix of_block = block.stiffness_pattern();
    evaluate(block, own, of_block);
    k.coeffs().segment(next, of_block.nonZeros()) = of_block.coeffs();
    next += of_block.nonZeros();
  });
}

void BlockDiagonalSystem::stiffness(const ConstVec& q, SymmetricMatrix& k) const {
  if (!has_stiffness()) throw std::logic_error("a block of the system computes no K");
  assemble(q, k, [](const System& block, const ConstVec& own, SymmetricMatrix& of_block) {
    block.stiffness(own, of_block);
  });
}

void BlockDiagonalSystem::weighted_stiffness(const ConstVec& q, double compression_weight,
                                             SymmetricMatrix& k) const {
  assemble(q, k, [&](const System& block, const ConstVec& own, SymmetricMatrix& of_block) {
    capability<SplitStiffness>(block)->weighted_stiffness(own, compression_weight, of_block);
  });
}

void BlockDiagonalSystem::material_stiffness(const ConstVec& q, SymmetricMatrix& k) const {
  assemble(q, k, [](const System& block, const ConstVec& own, SymmetricMatrix& of_block) {
    capability<SplitStiffness>(block)->material_stiffness(own, of_block);
  });
}

void BlockDiagonalSystem::laplacian(SymmetricMatrix& l) const {
  assemble(Vec::Zero(size()), l, [](const System& block, const Vec&, SymmetricMatrix& of_block) {
    capability<Laplacian>(block)->laplacian(of_block);
  });
}

bool BlockDiagonalSystem::bounds_stiffness() const {
  return std::ranges::all_of(
      blocks_, [](const auto& block) { return capability<Laplacian>(*block)->bounds_stiffness(); });
}

bool BlockDiagonalSystem::stiffness_is_constant() const {
  return std::ranges::all_of(blocks_,
                             [](const auto& block) { return block->stiffness_is_constant(); });
}

bool BlockDiagonalSystem::is_linear_at(const ConstVec& q) const {
  bool is_linear = true;
  for_each(blocks_, q, [&](const System& block, const ConstVec& own, Index) {
    const auto* pieces = capability<PiecewiseLinear>(block);
    is_linear = is_linear && (pieces ? pieces->is_linear_at(own) : block.stiffness_is_constant());
  });
  return is_linear;
}

bool BlockDiagonalSystem::is_valid_at(const ConstVec& q) const {
  bool is_valid = true;
  for_each(blocks_, q, [&](const System& block, const ConstVec& own, Index) {
    const auto* validity = capability<Validity>(block);
    is_valid = is_valid && (!validity || validity->is_valid_at(own));
  });
  return is_valid;
}

std::optional<double> BlockDiagonalSystem::end_of_validity(const State& from,
                                                           const State& to) const {
  std::optional<double> first;
  for_each(blocks_, from.q, [&](const System& block, const ConstVec& own, Index at) {
    const auto* validity = capability<Validity>(block);
    if (!validity) return;
    const Index n = block.size();
    const auto t = validity->end_of_validity({from.t, own, from.v.segment(at, n)},
                                             {to.t, to.q.segment(at, n), to.v.segment(at, n)});
    if (t && (!first || *t < *first)) first = t;
  });
  return first;
}

Index BlockDiagonalSystem::kinks() const {
  Index count = 0;
  for (const auto& block : blocks_) {
    if (const auto* own = capability<Kinks>(*block)) count += own->kinks();
  }
  return count;
}

void BlockDiagonalSystem::kink_lengths(const ConstVec& q, MutableVec lengths) const {
  Index next = 0;
  for_each(blocks_, q, [&](const System& block, const ConstVec& own, Index) {
    const auto* kinks = capability<Kinks>(block);
    if (!kinks) return;
    kinks->kink_lengths(own, lengths.segment(next, kinks->kinks()));
    next += kinks->kinks();
  });
}

}  // namespace qddot
