#include "qddot/model/kernels/stiffness_kernel.hpp"

#include <algorithm>

namespace qddot::kernels {
namespace {

template <int D>
bool is_full(const Layout<D>& layout, int i, int j) {
  return layout.is_full(i) && layout.is_full(j);
}

// The start in K's values of the block of two full nodes; -1 if there is none.
template <int D>
int block_of(const SymmetricMatrix& pattern, const Layout<D>& layout, int i, int j) {
  const auto [column, row] = std::minmax({layout.first(i), layout.first(j)});
  const int* rows = pattern.innerIndexPtr();
  const int *begin = rows + pattern.outerIndexPtr()[column],
            *end = rows + pattern.outerIndexPtr()[column + 1];
  const int* found = std::lower_bound(begin, end, row);
  return found < end && *found == row ? static_cast<int>(found - rows) : -1;
}

// The number of links between full nodes of each block, by the block's start.
template <int D>
std::vector<int> links_by_block(const Network& network, const Layout<D>& layout,
                                const SymmetricMatrix& pattern) {
  std::vector<int> count(pattern.nonZeros());
  for (const auto& link : network.links) {
    if (is_full(layout, link.i, link.j)) ++count[block_of(pattern, layout, link.i, link.j)];
  }
  return count;
}

void mark(std::vector<bool>& written, int first, int values) {
  std::fill_n(written.begin() + first, values, true);
}

}  // namespace

template <int D>
StiffnessKernel<D>::StiffnessKernel(const Network& network, const Layout<D>& layout,
                                    const SpringsByNode<D>& springs,
                                    const SymmetricMatrix& pattern) {
  const std::vector<int> links = links_by_block(network, layout, pattern);
  int full = 0;
  for (const auto& link : network.links) {
    if (!is_full(layout, link.i, link.j)) continue;
    if (links[block_of(pattern, layout, link.i, link.j)] > 1) links_left_out_.push_back(full);
    ++full;
  }
  Written written(pattern.nonZeros());
  place_columns(springs, pattern, written);
  place_slots(layout, springs, pattern, links, written);
  for (int i = 0; i < std::ssize(written); ++i) {
    if (!written[i]) zeros_.push_back(i);
  }
}

// The starts of the blocks on the diagonal.
template <int D>
void StiffnessKernel<D>::place_columns(const SpringsByNode<D>& springs,
                                       const SymmetricMatrix& pattern, Written& written) {
  const int rows = springs.slices().rows();
  columns_.resize(D * rows);
  for (int row = 0; row < rows; ++row) {
    int own = 0;
    for (int a = D; a-- > 0;) {
      const int unknown = springs.unknowns(row)[a];
      int& column = columns_[D * row + a];
      column = unknown >= 0 ? pattern.outerIndexPtr()[unknown] : -1;
      if (unknown >= 0) mark(written, column, ++own);
    }
  }
}

// The starts of the blocks below the diagonal, in the order of the springs' slots.
template <int D>
void StiffnessKernel<D>::place_slots(const Layout<D>& layout, const SpringsByNode<D>& springs,
                                     const SymmetricMatrix& pattern, const std::vector<int>& links,
                                     Written& written) {
  const NeighbourSlices& slices = springs.slices();
  // The block of a row and a place, if both are nodes with one link between them and the place is
  // the later one.
  const auto target = [&](int row, int place) {
    if (place >= slices.rows()) return -1;
    const int node = slices.node[row], later = slices.node[place];
    if (node < 0 || later <= node || !is_full(layout, node, later)) return -1;
    const int block = block_of(pattern, layout, node, later);
    return block >= 0 && links[block] == 1 ? block : -1;
  };
  const SlotLaw* law = slices.slot_laws.data();
  const auto add_slot = [&](int row, const auto& place_of) {
    std::vector<int> targets(slice_rows, -1);
    for (int t = 0; t < slice_rows; ++t) {
      // A row without a spring has one of stiffness zero.
      const bool is_spring = slices.laws[law->stiffness + t] > 0 ||
                             (slices.law_vectors == 3 && slices.laws[law->quartic + t] > 0);
      if (is_spring) targets[t] = target(row + t, place_of(t));
      if (targets[t] < 0) continue;
      const int* columns = columns_.data() + D * (row + t);
      for (int b = 0; b < D; ++b) mark(written, targets[t] + columns[b] - columns[0] - b, D);
    }
    ++law;
    const bool has_one = std::ranges::any_of(targets, [](int block) { return block >= 0; });
    slot_targets_.push_back(has_one ? static_cast<int>(targets_.size()) : -1);
    if (has_one) targets_.insert(targets_.end(), targets.begin(), targets.end());
  };
  for (int s = 0; s < slices.count(); ++s) {
    const auto &begin = slices.slices[s], &end = slices.slices[s + 1];
    for (int i = begin.shift; i < end.shift; ++i) {
      add_slot(s * slice_rows, [&](int t) { return s * slice_rows + t + slices.shifts[i]; });
    }
    for (int i = begin.gather; i < end.gather; i += slice_rows) {
      add_slot(s * slice_rows, [&](int t) { return slices.gathers[i + t]; });
    }
  }
}

template <int D>
void StiffnessKernel<D>::write(const SpringsByNode<D>& springs, const At& at, TensionPart part,
                               SymmetricMatrix& k) const {
  const SpringTable table = springs.table();
  const StiffnessTable own{slot_targets_.data(), targets_.data(), columns_.data()};
  double* values = k.valuePtr();
  springs.for_slices(at, [&](const Positions& positions, int from, int end) {
    springs.kernels().stiffness(table, positions, own, part, values, from, end);
  });
  for (const int i : zeros_) values[i] = 0;
}

template <int D>
void StiffnessKernel<D>::stiffness(const SpringsByNode<D>& springs, const At& at,
                                   double compression, SymmetricMatrix& k) const {
  write(springs, at, {.is_material = false, .compression = compression}, k);
}

template <int D>
void StiffnessKernel<D>::material_stiffness(const SpringsByNode<D>& springs, const At& at,
                                            SymmetricMatrix& k) const {
  write(springs, at, {.is_material = true, .compression = 1}, k);
}

template class StiffnessKernel<1>;
template class StiffnessKernel<2>;
template class StiffnessKernel<3>;

}  // namespace qddot::kernels
