#include "qddot/algebra/laplacian_mass.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace qddot {
namespace {

// The sets of unknowns that entries of L join, directly or through others; each ascending.
std::vector<std::vector<Index>> joined_unknowns(const SymmetricMatrix& l) {
  std::vector<Index> root(static_cast<std::size_t>(l.cols()));
  std::iota(root.begin(), root.end(), Index{0});
  const auto find = [&](Index i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (Index column = 0; column < l.cols(); ++column) {
    Index own = find(column);
    for (SymmetricMatrix::InnerIterator at(l, column); at; ++at) {
      if (at.value() == 0) continue;
      const Index other = find(at.row());
      if (other == own) continue;
      const auto later = std::max(own, other);
      own = root[later] = std::min(own, other);
    }
  }
  std::vector<std::vector<Index>> sets;
  std::vector<Index> set_of(root.size());
  for (Index i = 0; i < l.cols(); ++i) {
    if (root[i] == i) {
      set_of[i] = std::ssize(sets);
      sets.emplace_back();
    }
    set_of[i] = set_of[find(i)];
    sets[set_of[i]].push_back(i);
  }
  return sets;
}

bool same(const SymmetricMatrix& a, const SymmetricMatrix& b) {
  const auto equal = [](const auto* x, const auto* y, Index n) { return std::equal(x, x + n, y); };
  return a.cols() == b.cols() && a.nonZeros() == b.nonZeros() &&
         equal(a.outerIndexPtr(), b.outerIndexPtr(), a.cols()) &&
         equal(a.innerIndexPtr(), b.innerIndexPtr(), a.nonZeros()) &&
         equal(a.valuePtr(), b.valuePtr(), a.nonZeros());
}

}  // namespace

LaplacianMass::LaplacianMass(const System& system, double rate) {
  SymmetricMatrix l = system.stiffness_pattern();
  system.laplacian()->assemble_laplacian(l);
  if (SymmetricMatrix bound = l; rate > 0 && system.damping()->bound_damping(bound)) {
    l.coeffs() += rate * bound.coeffs();
  }
  std::vector<Index> place(static_cast<std::size_t>(l.cols()));
  for (std::vector<Index>& unknowns : joined_unknowns(l)) {
    const Index n = std::ssize(unknowns);
    for (Index i = 0; i < n; ++i) place[unknowns[i]] = i;
    Block block{.mass = system.mass()(unknowns), .l = SymmetricMatrix(n, n)};
    Index entries = 0;
    for (const Index i : unknowns) entries += l.col(i).nonZeros();
    block.l.reserve(entries);
    for (Index i = 0; i < n; ++i) {
      block.l.startVec(i);
      for (SymmetricMatrix::InnerIterator at(l, unknowns[i]); at; ++at) {
        if (at.value() == 0 && at.row() != at.col()) continue;
        block.l.insertBack(place[at.row()], i) = at.value();
      }
    }
    block.l.finalize();
    const auto found = std::ranges::find_if(blocks_, [&](const Block& other) {
      return other.mass.size() == n && other.mass == block.mass && same(other.l, block.l);
    });
    Block& owner = found == blocks_.end() ? blocks_.emplace_back(std::move(block)) : *found;
    owner.unknowns.push_back(std::move(unknowns));
  }
  for (Block& block : blocks_) {
    const Index n = block.mass.size();
    block.factors = make_multifrontal(block.l, block.mass);
    block.b.resize(n);
    block.x.resize(n);
    if (block.unknowns.size() == 1) continue;
    block.four_b.setZero(n, 4);
    block.four_x.setZero(n, 4);
  }
}

bool LaplacianMass::factorize(double s) {
  return std::ranges::all_of(
      blocks_, [&](Block& block) { return block.factors->factorize_positive(1, -s, block.l); });
}

void LaplacianMass::solve(const Vec& b, Vec& x) {
  for (Block& block : blocks_) {
    const Index n = block.mass.size();
    for (std::span<std::vector<Index>> left(block.unknowns); !left.empty();) {
      const auto now = left.first(std::min<std::size_t>(left.size(), 4));
      left = left.subspan(now.size());
      if (now.size() == 1) {
        for (Index i = 0; i < n; ++i) block.b[i] = b[now[0][i]];
        block.factors->solve(block.b, block.x);
        for (Index i = 0; i < n; ++i) x[now[0][i]] = block.x[i];
        continue;
      }
      for (std::size_t c = 0; c < now.size(); ++c) {
        for (Index i = 0; i < n; ++i) block.four_b(i, c) = b[now[c][i]];
      }
      block.factors->solve(block.four_b, block.four_x);
      for (std::size_t c = 0; c < now.size(); ++c) {
        for (Index i = 0; i < n; ++i) x[now[c][i]] = block.four_x(i, c);
      }
    }
  }
}

std::vector<Index> LaplacianMass::sizes() const {
  std::vector<Index> sizes;
  for (const Block& block : blocks_) sizes.push_back(block.mass.size());
  return sizes;
}

}  // namespace qddot
