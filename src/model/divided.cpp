#include "qddot/model/divided.hpp"

#include <algorithm>

namespace qddot {
namespace {

Vec all_masses(const std::vector<std::unique_ptr<System>>& parts) {
  Index n = 0;
  for (const auto& part : parts) n += part->size();
  Vec mass(n);
  Index at = 0;
  for (const auto& part : parts) {
    mass.segment(at, part->size()) = part->mass();
    at += part->size();
  }
  return mass;
}

// Calls action(part, its segment of q, where that begins) for each part.
template <class Action>
void for_each(const std::vector<std::unique_ptr<System>>& parts, const Vec& q,
              const Action& action) {
  Index at = 0;
  for (const auto& part : parts) {
    action(*part, Vec(q.segment(at, part->size())), at);
    at += part->size();
  }
}

}  // namespace

Divided::Divided(std::vector<std::unique_ptr<System>> parts)
    : System(all_masses(parts)), parts_(std::move(parts)), pattern_(size(), size()) {
  Index nonzeros = 0;
  for (const auto& part : parts_) nonzeros += part->stiffness_pattern().nonZeros();
  pattern_.reserve(nonzeros);
  Index at = 0;
  for (const auto& part : parts_) {
    const SymmetricMatrix& block = part->stiffness_pattern();
    for (Index column = 0; column < block.cols(); ++column) {
      pattern_.startVec(at + column);
      for (SymmetricMatrix::InnerIterator entry(block, column); entry; ++entry) {
        pattern_.insertBack(at + entry.row(), at + column) = 0;
      }
    }
    at += part->size();
  }
  pattern_.finalize();
}

double Divided::potential(const Vec& q) const {
  double v = 0;
  for_each(parts_, q, [&](const System& part, const Vec& own, Index) { v += part.potential(own); });
  return v;
}

void Divided::force(const Vec& q, Vec& f) const {
  for_each(parts_, q, [&](const System& part, const Vec& own, Index at) {
    Vec on_part(part.size());
    part.force(own, on_part);
    f.segment(at, part.size()) = on_part;
  });
}

void Divided::mean_force(const Vec& a, const Vec& b, Vec& f) const {
  for_each(parts_, a, [&](const System& part, const Vec& own, Index at) {
    Vec on_part(part.size());
    part.mean_force(own, b.segment(at, part.size()), on_part);
    f.segment(at, part.size()) = on_part;
  });
}

template <class Evaluate>
void Divided::assemble(const Vec& q, SymmetricMatrix& k, const Evaluate& evaluate) const {
  Index next = 0;
  for_each(parts_, q, [&](const System& part, const Vec& own, Index) {
    SymmetricMatrix block = part.stiffness_pattern();
    evaluate(part, own, block);
    k.coeffs().segment(next, block.nonZeros()) = block.coeffs();
    next += block.nonZeros();
  });
}

void Divided::softened_stiffness(const Vec& q, double compression, SymmetricMatrix& k) const {
  assemble(q, k, [compression](const System& part, const Vec& own, SymmetricMatrix& block) {
    part.softened_stiffness(own, compression, block);
  });
}

void Divided::material_stiffness(const Vec& q, SymmetricMatrix& k) const {
  assemble(q, k, [](const System& part, const Vec& own, SymmetricMatrix& block) {
    part.material_stiffness(own, block);
  });
}

HasLaplacian Divided::has_laplacian() const {
  HasLaplacian least = HasLaplacian::as_bound;
  for (const auto& part : parts_) least = std::min(least, part->has_laplacian());
  return least;
}

void Divided::laplacian(SymmetricMatrix& l) const {
  assemble(Vec::Zero(size()), l,
           [](const System& part, const Vec&, SymmetricMatrix& block) { part.laplacian(block); });
}

bool Divided::stiffness_is_constant() const {
  return std::ranges::all_of(parts_,
                             [](const auto& part) { return part->stiffness_is_constant(); });
}

bool Divided::is_linear_at(const Vec& q) const {
  bool is_linear = true;
  for_each(parts_, q, [&](const System& part, const Vec& own, Index) {
    is_linear = is_linear && part.is_linear_at(own);
  });
  return is_linear;
}

bool Divided::holds_at(const Vec& q) const {
  bool holds = true;
  for_each(parts_, q,
           [&](const System& part, const Vec& own, Index) { holds = holds && part.holds_at(own); });
  return holds;
}

std::optional<double> Divided::stops_holding(const State& from, const State& to) const {
  std::optional<double> first;
  for_each(parts_, from.q, [&](const System& part, const Vec& own, Index at) {
    const Index n = part.size();
    const auto t = part.stops_holding({from.t, own, from.v.segment(at, n)},
                                      {to.t, to.q.segment(at, n), to.v.segment(at, n)});
    if (t && (!first || *t < *first)) first = t;
  });
  return first;
}

}  // namespace qddot
