#pragma once

#include <vector>

#include "qddot/model/kernels/springs_by_node.hpp"

namespace qddot::kernels {

// K of a network's springs by the processor's vectors: each node writes its own columns,
//   K_ii = -sum over its springs of B,   K_ji = B for each later node j that it has a link to,
// B as in spring.hpp, so that each number is written once and by any thread. It differs from a sum
// spring by spring by rounding, and by nothing with the number of threads.
template <int D>
class StiffnessKernel {
 public:
  // K's pattern is that of BlockPattern.
  StiffnessKernel(const Network& network, const Layout<D>& layout, const SpringsByNode<D>& springs,
                  const SymmetricMatrix& pattern);

  // Blocks K_ji that are left zero, for their springs to be added: those of image links, of links
  // whose nodes have a coordinate that is no unknown, and of links of which several join the same
  // nodes. The last are these, numbered in order among the network's links of full nodes.
  const std::vector<int>& links_left_out() const { return links_left_out_; }

  // With B = spring_stiffness(law, d, compression). q: n; k: of the pattern.
  void stiffness(const SpringsByNode<D>& springs, const ConstVec& q, double compression,
                 SymmetricMatrix& k) const;
  // With B = spring_material_stiffness(law, d).
  void material_stiffness(const SpringsByNode<D>& springs, const ConstVec& q,
                          SymmetricMatrix& k) const;

 private:
  // Which of K's values something here writes.
  using Written = std::vector<bool>;
  void place_columns(const SpringsByNode<D>& springs, const SymmetricMatrix& pattern,
                     Written& written);
  void place_slots(const Layout<D>& layout, const SpringsByNode<D>& springs,
                   const SymmetricMatrix& pattern, const std::vector<int>& links, Written& written);
  void write(const SpringsByNode<D>& springs, const ConstVec& q, TensionPart part,
             SymmetricMatrix& k) const;

  std::vector<int> links_left_out_;
  // Where in targets_ each slot has, for its rows, the value in K that a block begins with,
  // or -1; -1 where it has none.
  std::vector<int> slot_targets_, targets_;
  std::vector<int> columns_;  // D of each row, where its unknowns' columns begin; or -1
  std::vector<int> zeros_;    // what nobody here writes
};

}  // namespace qddot::kernels
