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

Index phases_of(const System& block) {
  return block.switching() ? block.switching()->phase_count() : 0;
}

// Calls action(block, its segment of `at`, the segment's start) for each block.
template <class Action>
void for_each(const std::vector<std::unique_ptr<System>>& blocks, const At& at,
              const Action& action) {
  Index first = 0;
  At own = at;
  for (const auto& block : blocks) {
    At of_block = own.segment(first, block->size());
    action(*block, of_block, first);
    first += block->size();
    if (own.phases) own.phases += phases_of(*block);
  }
}

// Whether all blocks, or any, say yes to a question or have a capability: a member of System.
template <class Said>
bool all_have(const std::vector<std::unique_ptr<System>>& blocks, Said (System::*member)() const) {
  return std::ranges::all_of(blocks,
                             [=](const auto& block) { return bool((block.get()->*member)()); });
}
template <class Said>
bool any_has(const std::vector<std::unique_ptr<System>>& blocks, Said (System::*member)() const) {
  return std::ranges::any_of(blocks,
                             [=](const auto& block) { return bool((block.get()->*member)()); });
}

}  // namespace

BlockDiagonalSystem::BlockDiagonalSystem(std::vector<std::unique_ptr<System>> blocks)
    : CapableSystem(all_masses(blocks)), blocks_(std::move(blocks)) {}

bool BlockDiagonalSystem::has_stiffness() const {
  return all_have(blocks_, &System::has_stiffness);
}

const SymmetricMatrix& BlockDiagonalSystem::stiffness_pattern() const {
  std::call_once(pattern_made_, [&] {
    if (has_stiffness()) pattern_ = joined_patterns();
  });
  return pattern_;
}

bool BlockDiagonalSystem::bound_row_sums(const At& at, Vec& sums) const {
  sums.resize(size());
  bool all = true;
  Vec own_sums;
  for_each(blocks_, at, [&](const System& block, const At& own, Index first) {
    all = all && block.bound_row_sums(own, own_sums);
    if (all) sums.segment(first, block.size()) = own_sums;
  });
  return all;
}

bool BlockDiagonalSystem::multiply_stiffness(const At& at, const ConstVec& x, MutableVec y) const {
  bool all = true;
  const VecView of = x;
  for_each(blocks_, at, [&](const System& block, const At& own, Index first) {
    const Index n = block.size();
    all = all && block.multiply_stiffness(own, of.segment(first, n), y.segment(first, n));
  });
  return all;
}

Index BlockDiagonalSystem::stiffness_entries() const {
  Index entries = 0;
  for (const auto& block : blocks_) entries += block->stiffness_entries();
  return entries;
}

SymmetricMatrix BlockDiagonalSystem::joined_patterns() const {
  SymmetricMatrix pattern(size(), size());
  Index nonzeros = 0;
  for (const auto& block : blocks_) nonzeros += block->stiffness_pattern().nonZeros();
  pattern.reserve(nonzeros);
  Index at = 0;
  for (const auto& block : blocks_) {
    const SymmetricMatrix& own = block->stiffness_pattern();
    for (Index column = 0; column < own.cols(); ++column) {
      pattern.startVec(at + column);
      for (SymmetricMatrix::InnerIterator entry(own, column); entry; ++entry) {
        pattern.insertBack(at + entry.row(), at + column) = 0;
      }
    }
    at += block->size();
  }
  pattern.finalize();
  return pattern;
}

const SplitStiffness* BlockDiagonalSystem::split_stiffness() const {
  return all_have(blocks_, &System::split_stiffness) ? this : nullptr;
}

const DiscreteGradient* BlockDiagonalSystem::discrete_gradient() const {
  return all_have(blocks_, &System::discrete_gradient) ? this : nullptr;
}

const Laplacian* BlockDiagonalSystem::laplacian() const {
  return all_have(blocks_, &System::laplacian) ? this : nullptr;
}

const PiecewiseLinear* BlockDiagonalSystem::pieces() const {
  return any_has(blocks_, &System::pieces) ? this : nullptr;
}

const Validity* BlockDiagonalSystem::validity() const {
  return any_has(blocks_, &System::validity) ? this : nullptr;
}

const Kinks* BlockDiagonalSystem::kinks() const {
  return any_has(blocks_, &System::kinks) ? this : nullptr;
}

const Damping* BlockDiagonalSystem::damping() const {
  const bool all = std::ranges::all_of(
      blocks_, [](const auto& block) { return block->is_conservative() || block->damping(); });
  return all && any_has(blocks_, &System::damping) ? this : nullptr;
}

void BlockDiagonalSystem::friction(const At& at, MutableVec f) const {
  for_each(blocks_, at, [&](const System& block, const At& own, Index first) {
    auto of_block = f.segment(first, block.size());
    if (const Damping* damping = block.damping()) {
      damping->friction(own, of_block);
    } else {
      of_block.setZero();
    }
  });
}

std::optional<double> BlockDiagonalSystem::secant_friction(const BackwardRate& rate,
                                                           const ConstVec& v, MutableVec f) const {
  double power = 0;
  Index at = 0;
  for (const auto& block : blocks_) {
    const Index n = block->size();
    const Vec q = rate.q0.segment(at, n), own_v = v.segment(at, n);
    auto own = f.segment(at, n);
    const Damping* damping = block->damping();
    if (!damping) {
      own.setZero();
    } else if (damping->has_dashpots()) {
      const Vec q1 = rate.q1.segment(at, n), q2 = rate.q2.segment(at, n);
      const auto of_block =
          damping->secant_friction({q, q1, q2, rate.a0, rate.a1, rate.a2}, own_v, own);
      if (!of_block) return {};
      power += *of_block;
    } else {
      damping->friction({0, q, own_v}, own);
      power -= own.dot(own_v);
    }
    at += n;
  }
  return power;
}

void BlockDiagonalSystem::damping_matrix(const At& at, SymmetricMatrix& c) const {
  assemble(at, c, [](const System& block, const At& own, SymmetricMatrix& of_block) {
    if (const Damping* damping = block.damping()) damping->damping_matrix(own, of_block);
  });
}

bool BlockDiagonalSystem::damping_is_constant() const {
  return std::ranges::all_of(blocks_, [](const auto& block) {
    return !block->damping() || block->damping()->damping_is_constant();
  });
}

bool BlockDiagonalSystem::has_dashpots() const {
  const auto air = [](const auto& block) {
    return block->damping() ? block->damping()->air_damping() : 0;
  };
  // Different airs are no alpha M.
  return std::ranges::any_of(blocks_, [&](const auto& block) {
    return (block->damping() && block->damping()->has_dashpots()) || air(block) != air(blocks_[0]);
  });
}

double BlockDiagonalSystem::air_damping() const {
  return has_dashpots() ? 0 : blocks_.front()->damping()->air_damping();
}

std::optional<double> BlockDiagonalSystem::damping_time() const {
  if (!has_dashpots()) return 0;
  return {};
}

bool BlockDiagonalSystem::is_conservative() const {
  return all_have(blocks_, &System::is_conservative);
}

bool BlockDiagonalSystem::is_autonomous() const {
  return all_have(blocks_, &System::is_autonomous);
}

// It has Driving if that is all that makes forces of blocks depend on time.
const Driving* BlockDiagonalSystem::driving() const {
  const bool all = std::ranges::all_of(
      blocks_, [](const auto& block) { return block->is_autonomous() || block->driving(); });
  return all && any_has(blocks_, &System::driving) ? this : nullptr;
}

Work BlockDiagonalSystem::driving_power(const At& at) const {
  Work power;
  for_each(blocks_, at, [&](const System& block, const At& own, Index) {
    if (const Driving* driving = block.driving()) power += driving->driving_power(own);
  });
  return power;
}

double BlockDiagonalSystem::potential_change(double from, double to, const At& at) const {
  double change = 0;
  for_each(blocks_, at, [&](const System& block, const At& own, Index) {
    if (const Driving* driving = block.driving())
      change += driving->potential_change(from, to, own);
  });
  return change;
}

void BlockDiagonalSystem::force_rate(const At& at, MutableVec rate) const {
  rate.setZero();
  for_each(blocks_, at, [&](const System& block, const At& own, Index first) {
    if (const Driving* driving = block.driving())
      driving->force_rate(own, rate.segment(first, block.size()));
  });
}

std::vector<Corner> BlockDiagonalSystem::corners() const {
  std::vector<Corner> all;
  for (const auto& block : blocks_) {
    if (!block->driving()) continue;
    const std::vector<Corner> own = block->driving()->corners();
    all.insert(all.end(), own.begin(), own.end());
  }
  std::ranges::sort(all, {}, &Corner::t);
  return all;
}

const Switching* BlockDiagonalSystem::switching() const {
  return any_has(blocks_, &System::switching) ? this : nullptr;
}

Index BlockDiagonalSystem::phase_count() const {
  Index count = 0;
  for (const auto& block : blocks_) count += phases_of(*block);
  return count;
}

std::optional<int> BlockDiagonalSystem::order_of_slack() const {
  std::optional<int> order;
  for (const auto& block : blocks_) {
    const std::optional<int> own =
        block->switching() ? block->switching()->order_of_slack() : std::nullopt;
    if (own) order = std::min(order.value_or(*own), *own);
  }
  return order;
}

void BlockDiagonalSystem::set_phases(const At& at, bool finds_slack,
                                     std::span<Phase> phases) const {
  for_each(blocks_, at, [&](const System& block, const At& own, Index) {
    if (!block.switching()) return;
    block.switching()->set_phases(own, finds_slack, phases.first(phases_of(block)));
    phases = phases.subspan(phases_of(block));
  });
}

std::optional<Switching::Change> BlockDiagonalSystem::first_change(const State& from,
                                                                   const State& to,
                                                                   std::span<const Phase> phases,
                                                                   const Changed& changed) const {
  std::optional<Change> first;
  int before = 0;
  for_each(blocks_, from, [&](const System& block, const At& own, Index at) {
    if (!block.switching()) return;
    const Index n = block.size(), count = phases_of(block);
    auto change = block.switching()->first_change(
        {own.t, own.q, own.v}, {to.t, to.q.segment(at, n), to.v.segment(at, n)},
        phases.subspan(before, count),
        {changed.has_changed.subspan(before, count), changed.allowance});
    if (change && (!first || change->t < first->t)) {
      change->number += before;
      first = change;
    }
    before += static_cast<int>(count);
  });
  return first;
}

template <class Action>
auto BlockDiagonalSystem::in_block(const At& at, int number, const Action& action) const {
  Index first = 0;
  for (const auto& block : blocks_) {
    const auto count = static_cast<int>(phases_of(*block));
    if (number < count)
      return action(*block->switching(), at.segment(first, block->size()), number);
    number -= count;
    first += block->size();
  }
  throw std::logic_error("no spring of the system has that number");
}

Switching::Margin BlockDiagonalSystem::margin(const At& at, int number, Phase to) const {
  return in_block(at, number, [&](const Switching& block, const At& own, int spring) {
    return block.margin(own, spring, to);
  });
}

void BlockDiagonalSystem::add_due_changes(const At& at, std::span<const Phase> phases,
                                          std::vector<Change>& due) const {
  int before = 0;
  for_each(blocks_, at, [&](const System& block, const At& own, Index) {
    if (!block.switching()) return;
    const Index count = phases_of(block);
    const std::size_t known = due.size();
    block.switching()->add_due_changes(own, phases.subspan(before, count), due);
    for (std::size_t k = known; k < due.size(); ++k) due[k].number += before;
    before += static_cast<int>(count);
  });
}

double BlockDiagonalSystem::energy_of(const At& at, int number) const {
  return in_block(at, number, [](const Switching& block, const At& own, int spring) {
    return block.energy_of(own, spring);
  });
}

double BlockDiagonalSystem::strain_of(const At& at, int number) const {
  return in_block(at, number, [](const Switching& block, const At& own, int spring) {
    return block.strain_of(own, spring);
  });
}

bool BlockDiagonalSystem::has_potential() const {
  return all_have(blocks_, &System::has_potential);
}

double BlockDiagonalSystem::potential(const At& at) const {
  double v = 0;
  for_each(blocks_, at,
           [&](const System& block, const At& own, Index) { v += block.potential(own); });
  return v;
}

void BlockDiagonalSystem::force(const At& at, MutableVec f) const {
  for_each(blocks_, at, [&](const System& block, const At& own, Index first) {
    block.force(own, f.segment(first, block.size()));
  });
}

void BlockDiagonalSystem::mean_force(const At& a, const At& b, MutableVec f) const {
  for_each(blocks_, a, [&](const System& block, const At& own, Index first) {
    const Index n = block.size();
    block.discrete_gradient()->mean_force(own, b.segment(first, n), f.segment(first, n));
  });
}

template <class Evaluate>
void BlockDiagonalSystem::assemble(const At& at, SymmetricMatrix& k,
                                   const Evaluate& evaluate) const {
  Index next = 0;
  for_each(blocks_, at, [&](const System& block, const At& own, Index) {
    SymmetricMatrix of_block = block.stiffness_pattern();
    evaluate(block, own, of_block);
    k.coeffs().segment(next, of_block.nonZeros()) = of_block.coeffs();
    next += of_block.nonZeros();
  });
}

void BlockDiagonalSystem::stiffness(const At& at, SymmetricMatrix& k) const {
  if (!has_stiffness()) throw std::logic_error("a block of the system computes no K");
  assemble(at, k, [](const System& block, const At& own, SymmetricMatrix& of_block) {
    block.stiffness(own, of_block);
  });
}

void BlockDiagonalSystem::weighted_stiffness(const At& at, double compression_weight,
                                             SymmetricMatrix& k) const {
  assemble(at, k, [&](const System& block, const At& own, SymmetricMatrix& of_block) {
    block.split_stiffness()->weighted_stiffness(own, compression_weight, of_block);
  });
}

void BlockDiagonalSystem::material_stiffness(const At& at, SymmetricMatrix& k) const {
  assemble(at, k, [](const System& block, const At& own, SymmetricMatrix& of_block) {
    block.split_stiffness()->material_stiffness(own, of_block);
  });
}

void BlockDiagonalSystem::assemble_laplacian(SymmetricMatrix& l) const {
  const Vec anywhere = Vec::Zero(size());
  assemble(anywhere, l, [](const System& block, const At&, SymmetricMatrix& of_block) {
    block.laplacian()->assemble_laplacian(of_block);
  });
}

bool BlockDiagonalSystem::bounds_stiffness() const {
  return std::ranges::all_of(
      blocks_, [](const auto& block) { return block->laplacian()->bounds_stiffness(); });
}

bool BlockDiagonalSystem::stiffness_is_constant() const {
  return all_have(blocks_, &System::stiffness_is_constant);
}

bool BlockDiagonalSystem::is_linear_at(const At& at) const {
  bool is_linear = true;
  for_each(blocks_, at, [&](const System& block, const At& own, Index) {
    const auto* pieces = block.pieces();
    is_linear = is_linear && (pieces ? pieces->is_linear_at(own) : block.stiffness_is_constant());
  });
  return is_linear;
}

bool BlockDiagonalSystem::is_valid_at(const At& at) const {
  bool is_valid = true;
  for_each(blocks_, at, [&](const System& block, const At& own, Index) {
    const auto* validity = block.validity();
    is_valid = is_valid && (!validity || validity->is_valid_at(own));
  });
  return is_valid;
}

std::optional<double> BlockDiagonalSystem::end_of_validity(const State& from,
                                                           const State& to) const {
  std::optional<double> first;
  for_each(blocks_, from, [&](const System& block, const At& own, Index at) {
    const auto* validity = block.validity();
    if (!validity) return;
    const Index n = block.size();
    const auto t = validity->end_of_validity({own.t, own.q, own.v},
                                             {to.t, to.q.segment(at, n), to.v.segment(at, n)});
    if (t && (!first || *t < *first)) first = t;
  });
  return first;
}

Index BlockDiagonalSystem::kink_count() const {
  Index count = 0;
  for (const auto& block : blocks_) {
    if (const auto* own = block->kinks()) count += own->kink_count();
  }
  return count;
}

void BlockDiagonalSystem::kink_lengths(const At& at, MutableVec lengths) const {
  Index next = 0;
  for_each(blocks_, at, [&](const System& block, const At& own, Index) {
    const auto* kinks = block.kinks();
    if (!kinks) return;
    kinks->kink_lengths(own, lengths.segment(next, kinks->kink_count()));
    next += kinks->kink_count();
  });
}

}  // namespace qddot
