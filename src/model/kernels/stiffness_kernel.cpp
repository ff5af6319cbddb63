#include "qddot/model/kernels/stiffness_kernel.hpp"

#include <algorithm>
#include <map>

namespace qddot::kernels {
namespace {

// The lower triangle of a symmetric D x D block, column by column.
template <int D>
constexpr int triangle = D*(D + 1) / 2;

// The entry of that triangle at row a, column b.
template <int D>
constexpr int entry(int a, int b) {
  const int row = std::max(a, b), column = std::min(a, b);
  return column * D - column * (column - 1) / 2 + row - column;
}

// Of one slot's springs: tau', and tau/l as it counts in B, given by `counted` from tau/l, l and
// l0. On a line B is tau' alone, which is K's to the last bit at every q where tau' is constant.
struct Slopes {
  Lanes along, across, inverse_length;
};
template <int D, int law_vectors, class Counted>
[[gnu::always_inline]] inline Slopes slopes(Lanes l2, const double* law, const Counted& counted) {
  const Lanes stiffness = load(law);
  if constexpr (law_vectors == 1 || (D == 1 && law_vectors == 2)) {
    return {stiffness, stiffness, Lanes{}};
  } else {
    const Lanes l = square_root(l2), rest_length = load(law + lanes), s = l - rest_length;
    Lanes along = stiffness, tension = s * stiffness;
    if constexpr (law_vectors == 3) {
      const Lanes quartic = load(law + 2 * lanes) * (s * s);
      along = stiffness + 3 * quartic;
      tension = s * (stiffness + quartic);
    }
    if constexpr (D == 1) return {along, along, Lanes{}};
    const Lanes one_by_l = 1 / l, inverse_length = l > 0 ? one_by_l : Lanes{};
    const Lanes across = l > 0 ? counted(tension * inverse_length, rest_length) : along;
    return {along, across, inverse_length};
  }
}

// Where in K's values the block of two nodes of full blocks begins; -1 where there is none.
template <int D>
int block_of(const SymmetricMatrix& pattern, const Layout<D>& layout, int i, int j) {
  const auto [column, row] = std::minmax({layout.first(i), layout.first(j)});
  const int* rows = pattern.innerIndexPtr();
  const int *begin = rows + pattern.outerIndexPtr()[column],
            *end = rows + pattern.outerIndexPtr()[column + 1];
  const int* found = std::lower_bound(begin, end, row);
  return found < end && *found == row ? static_cast<int>(found - rows) : -1;
}

// K_ji = B of each row that has a target.
template <int D>
[[gnu::always_inline]] inline void put_blocks(const Lanes (&block)[triangle<D>], const int* target,
                                              const std::array<int, D>* columns, double* values) {
  double entries[triangle<D>][lanes];
  for (int e = 0; e < triangle<D>; ++e) store(entries[e], block[e]);
  for (int t = 0; t < lanes; ++t) {
    if (target[t] < 0) continue;
    for (int b = 0; b < D; ++b) {
      // The node's own block takes one row less in each column.
      double* column = values + target[t] + columns[t][b] - columns[t][0] - b;
      for (int a = 0; a < D; ++a) column[a] = entries[entry<D>(a, b)][t];
    }
  }
}

// K_ii of each row, without the coordinates that are no unknowns.
template <int D>
[[gnu::always_inline]] inline void put_own(const Lanes (&own)[triangle<D>],
                                           const std::array<int, D>* columns, double* values) {
  double entries[triangle<D>][lanes];
  for (int e = 0; e < triangle<D>; ++e) store(entries[e], own[e]);
  for (int t = 0; t < lanes; ++t) {
    for (int b = 0; b < D; ++b) {
      if (columns[t][b] < 0) continue;
      double* value = values + columns[t][b];
      for (int a = b; a < D; ++a) {
        if (columns[t][a] >= 0) *value++ = entries[entry<D>(a, b)][t];
      }
    }
  }
}

}  // namespace

template <int D>
StiffnessKernel<D>::StiffnessKernel(const Network& network, const Layout<D>& layout,
                                    const SpringsByNode<D>& springs,
                                    const SymmetricMatrix& pattern) {
  // How many links each block has.
  std::vector<int> count(pattern.nonZeros());
  const auto is_full = [&](int i, int j) { return layout.is_full(i) && layout.is_full(j); };
  for (const auto& [i, j, law, holds, stiff, direction] : network.links) {
    if (is_full(i, j)) ++count[block_of(pattern, layout, i, j)];
  }
  int full = 0;
  for (const auto& [i, j, law, holds, stiff, direction] : network.links) {
    if (!is_full(i, j)) continue;
    if (count[block_of(pattern, layout, i, j)] > 1) links_left_out_.push_back(full);
    ++full;
  }
  const int* start = pattern.outerIndexPtr();
  const NeighbourSlices& slices = springs.slices();
  std::vector<bool> is_written(pattern.nonZeros());
  const auto mark = [&](int first, int values) {
    std::fill_n(is_written.begin() + first, values, true);
  };
  for (int row = 0; row < slices.rows(); ++row) {
    auto& columns = columns_.emplace_back();
    int own = 0;
    for (int a = D; a-- > 0;) {
      const int unknown = springs.unknowns(row)[a];
      columns[a] = unknown >= 0 ? start[unknown] : -1;
      if (unknown >= 0) mark(columns[a], ++own);
    }
  }
  // Of a row and a place, if both are nodes with one link between them, and the place's is later.
  const auto target = [&](int row, int place) {
    if (place >= slices.rows()) return -1;
    const int node = slices.node[row], later = slices.node[place];
    if (node < 0 || later <= node || !is_full(node, later)) return -1;
    const int block = block_of(pattern, layout, node, later);
    return block >= 0 && count[block] == 1 ? block : -1;
  };
  const double* law = slices.laws.data();
  const auto add_slot = [&](int row, const auto& place_of) {
    std::array<int, lanes> targets;
    targets.fill(-1);
    for (int t = 0; t < lanes; ++t) {
      // A slot has springs of no stiffness where a row has none.
      const bool is_spring = law[t] > 0 || (slices.law_vectors == 3 && law[2 * lanes + t] > 0);
      if (is_spring) targets[t] = target(row + t, place_of(t));
      if (targets[t] < 0) continue;
      for (int b = 0; b < D; ++b) {
        mark(targets[t] + columns_[row + t][b] - columns_[row + t][0] - b, D);
      }
    }
    law += slices.law_vectors * lanes;
    const bool has_one = std::ranges::any_of(targets, [](int block) { return block >= 0; });
    slot_targets_.push_back(has_one ? static_cast<int>(targets_.size()) : -1);
    if (has_one) targets_.insert(targets_.end(), targets.begin(), targets.end());
  };
  for (int s = 0; s < slices.count(); ++s) {
    const auto &begin = slices.slices[s], &end = slices.slices[s + 1];
    for (int i = begin.shift; i < end.shift; ++i) {
      add_slot(s * lanes, [&](int t) { return s * lanes + t + slices.shifts[i]; });
    }
    for (int i = begin.gather; i < end.gather; i += lanes) {
      add_slot(s * lanes, [&](int t) { return slices.gathers[i + t]; });
    }
  }
  for (int i = 0; i < std::ssize(is_written); ++i) {
    if (!is_written[i]) zeros_.push_back(i);
  }
}

template <int D>
template <class Counted>
void StiffnessKernel<D>::write(const SpringsByNode<D>& springs, const Vec& q,
                               const Counted& counted, SymmetricMatrix& k) const {
  switch (springs.slices().law_vectors) {
    case 1:
      return write<1>(springs, q, counted, k);
    case 2:
      return write<2>(springs, q, counted, k);
    default:
      return write<3>(springs, q, counted, k);
  }
}

template <int D>
template <int law_vectors, class Counted>
void StiffnessKernel<D>::write(const SpringsByNode<D>& springs, const Vec& q,
                               const Counted& counted, SymmetricMatrix& k) const {
  double* values = k.valuePtr();
  const NeighbourSlices& slices = springs.slices();
  springs.for_slices(q, [&](int slice, const auto& positions) {
    const int first = slices.slices[slice].shift + slices.slices[slice].gather / lanes;
    const auto* columns = columns_.data() + slice * lanes;
    Lanes own[triangle<D>] = {};
    springs.template for_slots<law_vectors>(
        slice, positions, [&](int slot, const Lanes(&d)[D], Lanes l2, const double* law) {
          const Slopes slope = slopes<D, law_vectors>(l2, law, counted);
          Lanes block[triangle<D>];
          for (int b = 0; b < D; ++b) {
            const Lanes n = d[b] * slope.inverse_length;
            for (int a = b; a < D; ++a) {
              Lanes& entry_ab = block[entry<D>(a, b)];
              entry_ab = (slope.along - slope.across) * n * (d[a] * slope.inverse_length);
              if (a == b) entry_ab = D == 1 ? slope.along : entry_ab + slope.across;
            }
          }
          for (int e = 0; e < triangle<D>; ++e) own[e] -= block[e];
          const int at = slot_targets_[first + slot];
          if (at >= 0) put_blocks<D>(block, targets_.data() + at, columns, values);
        });
    put_own<D>(own, columns, values);
  });
  for (const int i : zeros_) values[i] = 0;
}

template <int D>
void StiffnessKernel<D>::stiffness(const SpringsByNode<D>& springs, const Vec& q,
                                   double compression, SymmetricMatrix& k) const {
  write(
      springs, q,
      [compression](Lanes across, Lanes) { return across < 0 ? across * compression : across; }, k);
}

template <int D>
void StiffnessKernel<D>::material_stiffness(const SpringsByNode<D>& springs, const Vec& q,
                                            SymmetricMatrix& k) const {
  write(
      springs, q,
      [](Lanes across, Lanes rest_length) { return rest_length > 0 ? Lanes{} : across; }, k);
}

template class StiffnessKernel<1>;
template class StiffnessKernel<2>;
template class StiffnessKernel<3>;

}  // namespace qddot::kernels
