#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "qddot/algebra/large_array.hpp"
#include "qddot/algebra/symbolic_factorization.hpp"

namespace qddot {

// A symmetric matrix a D - s K, both triangles, stored by rows of B x B blocks (see block_starts).
// A product reads it once from front to back and writes each row once. Blocks of fewer unknowns are
// filled up with rows and columns of the identity. Vectors have B entries for each row of blocks,
// zero where filled up, and `slack` more, which may be read past the end.
template <int B>
class BlockRows {
 public:
  using Block = Eigen::Matrix<double, B, B>;
  using Entries = Eigen::Matrix<double, B, 1>;
  // A row's entries in computations. Three entries use the first of 4 lanes, as one register of the
  // processor has; the fourth has no meaning.
  using Lanes = Eigen::Array<double, B == 3 ? 4 : B, 1>;
  static constexpr Index slack = 1;

  BlockRows(const SymmetricMatrix& pattern, const std::vector<int>& starts)
      : first_(starts), row_start_(starts.size()), diagonal_(starts.size() - 1) {
    std::vector<int> row_of(pattern.rows());
    for (Index i = 0; i < rows(); ++i) {
      std::fill(row_of.begin() + first_[i], row_of.begin() + first_[i + 1], static_cast<int>(i));
    }
    // One entry for each block of the lower triangle: that of its first row and first column.
    const auto for_each_block = [&](const auto& see) {
      for (Index j = 0; j < rows(); ++j) {
        for (SymmetricMatrix::InnerIterator entry(pattern, first_[j]); entry; ++entry) {
          const int i = row_of[entry.row()];
          if (entry.row() == first_[i]) see(i, static_cast<int>(j));
        }
      }
    };
    for_each_block([&](int i, int j) {
      ++row_start_[i + 1];
      if (i != j) ++row_start_[j + 1];
    });
    for (Index i = 0; i < rows(); ++i) row_start_[i + 1] += row_start_[i];
    column_.resize(row_start_.back());
    next_.assign(row_start_.begin(), row_start_.end() - 1);
    // The lower triangle by columns fills each row from the left up to its diagonal, and behind it.
    for_each_block([&](int i, int j) {
      if (i == j) diagonal_[j] = next_[j];
      column_[next_[i]++] = j;
      if (i != j) column_[next_[j]++] = i;
    });
    values_ = LargeArray(entries() + slack);
  }

  Index rows() const { return std::ssize(first_) - 1; }
  Index size() const { return B * rows(); }
  // The number of values stored in blocks.
  Index entries() const { return B * B * std::ssize(column_); }
  Eigen::Map<const Block> diagonal(Index i) const {
    return Eigen::Map<const Block>(block(diagonal_[i]));
  }

  // Sets the matrix to a D - s K; k: with the pattern, d: n.
  void assemble(double a, const Vec& d, double s, const SymmetricMatrix& k) {
    std::copy(row_start_.begin(), row_start_.end() - 1, next_.begin());
    for (Index j = 0; j < rows(); ++j) {
      const int width = first_[j + 1] - first_[j];
      double* own = block(diagonal_[j]);
      for (int c = 0; c < B; ++c) {
        if (c >= width) {
          own[c * (B + 1)] = 1;
          continue;
        }
        const int column = first_[j] + c;
        const double* from = k.valuePtr() + k.outerIndexPtr()[column];
        for (int r = c; r < width; ++r) own[r + B * c] = own[c + B * r] = -s * *from++;
        own[c * (B + 1)] += a * d[column];
        for (int at = diagonal_[j] + 1; at < row_start_[j + 1]; ++at) {
          const int i = column_[at], height = first_[i + 1] - first_[i];
          double* right = block(at);       // row j, column i,
          double* left = block(next_[i]);  // and its transpose
          for (int r = 0; r < height; ++r) right[c + B * r] = left[r + B * c] = -s * *from++;
          if (c == width - 1) ++next_[i];
        }
      }
    }
  }

  // y = A x; returns x'y.
  double multiply(const double* x, double* y) const {
    double product = 0;
    for (Index i = 0; i < rows(); ++i) {
      std::array<Lanes, B> sum;  // one for each column of blocks, so that none waits for another
      sum.fill(Lanes::Zero());
      for (int at = row_start_[i]; at < row_start_[i + 1]; ++at) {
        const double *a = block(at), *xj = x + Index{B} * column_[at];
        for (int c = 0; c < B; ++c) sum[c] += Eigen::Map<const Lanes>(a + B * c) * xj[c];
      }
      for (int c = 1; c < B; ++c) sum[0] += sum[c];
      for (int r = 0; r < B; ++r) {
        y[B * i + r] = sum[0][r];
        product += sum[0][r] * x[B * i + r];
      }
    }
    return product;
  }

  // Copies n unknowns into a vector of rows, and back.
  void spread(const double* from, double* to) const {
    for (Index i = 0; i < rows(); ++i)
      std::copy(from + first_[i], from + first_[i + 1], to + B * i);
  }
  void gather(const double* from, double* to) const {
    for (Index i = 0; i < rows(); ++i)
      std::copy_n(from + B * i, first_[i + 1] - first_[i], to + first_[i]);
  }

 private:
  double* block(Index at) { return values_.get() + B * B * at; }
  const double* block(Index at) const { return values_.get() + B * B * at; }

  std::vector<int> first_;                          // unknown of each row
  std::vector<int> row_start_, diagonal_, column_;  // of blocks
  std::vector<int> next_;                           // the block of each row that is filled next
  LargeArray values_;                               // block by block, column by column
};

}  // namespace qddot
