#pragma once

#include <vector>

#include "qddot/model/system.hpp"

namespace qddot {

// Pivots that are eliminated together, because the columns of L below them (almost) agree.
struct Supernode {
  int first, pivots;      // the unknowns first, ..., first + pivots - 1 of the order
  int parent;             // the supernode of the first row below, later than this; -1 at a root
  std::vector<int> rows;  // the rows below the pivots, ascending
};

// The order in which a symmetric matrix is factorised, and the places of L's entries.
struct SymbolicFactorization {
  std::vector<int> place;             // place[i]: the position of unknown i in the order
  std::vector<Supernode> supernodes;  // in postorder: a subtree's are consecutive, its root last

  // The number of entries of L with its diagonal, and of operations to compute it. A pivot with r
  // rows below takes r divisions, r (r + 1) / 2 products and as many differences.
  double entries() const;
  double operations() const;
};

// Analyses an n x n pattern by CHOLMOD (Chen, Davis, Hager, Rajamanickam, ACM TOMS 35:3, 2008) on
// the graph of its blocks (block_starts): a block is one vertex. Throws std::runtime_error when out
// of memory.
SymbolicFactorization analyse(const SymmetricMatrix& pattern);

// The most unknowns of a block: those of a node.
inline constexpr int most_block_unknowns = 3;

// The first unknown of each block of a symmetric n x n pattern, and last n. A block is a run of at
// most three unknowns with the same neighbours, itself included, such as those of a node. Entries
// between two blocks are all there or all absent.
std::vector<int> block_starts(const SymmetricMatrix& pattern);

}  // namespace qddot
