#pragma once

#include <vector>

#include "qddot/model/kernels/springs_by_node.hpp"

namespace qddot::kernels {

// K of a network's springs in the processor's vectors: each node writes its own columns,
//   K_ii = -sum over its springs of B,   K_ji = B for each later node j that it has a link to,
// with B as in spring.hpp. So each number is written once, by any thread. K differs from a sum
// spring by spring by rounding only, and does not depend on the number of threads.
template <int D>
class StiffnessKernel {
 public:
  // K's pattern is that of BlockPattern.
  StiffnessKernel(const Network& network, const Layout<D>& layout, const SpringsByNode<D>& springs,
                  const SymmetricMatrix& pattern);

  // The links whose blocks K_ji stay zero because several links join the same nodes; the caller
  // adds them. They are numbered in order among the network's links of full nodes. Blocks of image
  // links, and of links at a node with a coordinate that is no unknown, stay zero too.
  const std::vector<int>& links_left_out() const { return links_left_out_; }

  // Writes K with B = spring_stiffness(law, d, compression). k: of the pattern.
  void stiffness(const SpringsByNode<D>& springs, const At& at, double compression,
                 SymmetricMatrix& k) const;
  // The same with B = spring_material_stiffness(law, d).
  void material_stiffness(const SpringsByNode<D>& springs, const At& at, SymmetricMatrix& k) const;

 private:
  // Marks the values of K that this kernel writes.
  using Written = std::vector<bool>;
  void place_columns(const SpringsByNode<D>& springs, const SymmetricMatrix& pattern,
                     Written& written);
  void place_slots(const Layout<D>& layout, const SpringsByNode<D>& springs,
                   const SymmetricMatrix& pattern, const std::vector<int>& links, Written& written);
  void write(const SpringsByNode<D>& springs, const At& at, TensionPart part,
             SymmetricMatrix& k) const;

  std::vector<int> links_left_out_;
  // For each slot, the start of its rows' values in targets_, or -1. A value there is the start of
  // a row's block in K, or -1 without a block.
  std::vector<int> slot_targets_, targets_;
  std::vector<int> columns_;  // D of each row: the start of its unknowns' columns, or -1
  std::vector<int> zeros_;    // values that this kernel does not write
};

}  // namespace qddot::kernels
