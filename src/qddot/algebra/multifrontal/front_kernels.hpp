#pragma once

// The data that the kernels of fronts read and write: plain numbers and pointers only, as in
// spring_kernels.hpp.
namespace qddot::multifrontal {

// The number of rows of a strip, into which dense matrices are cut; see vectors/strips.hpp.
constexpr int strip_height = 8;
// The number of strips that hold this many rows.
[[gnu::always_inline]] constexpr int strips_of(int rows) {
  return (rows + strip_height - 1) / strip_height;
}
// The number of pivots whose columns are subtracted from the rest of a front at once. With this
// many, a tile's rows of L stay in the first cache.
constexpr int panel = 96;

// Rows of an update that stay neighbours in the front they are added to.
struct Run {
  int from, to, length;
};

// Entries of K that are neighbours, and are so too in the columns of their front's pivots: in one
// column or, `across`, in one row of a strip of columns.
struct Entry {
  int source, target;
  short length;
  bool across;
};
struct Entries {
  const Entry *begin, *end;
};

// The matrix a D - s K by the values of D, in the order of elimination, and of K.
struct Combination {
  double a, s;
  const double *diagonal, *k;
};

// A = L D L' of strip_height pivots.
struct Block {
  double l[strip_height * strip_height];   // without the diagonal; L' above it
  double ld[strip_height * strip_height];  // columns of L D
  double pivot[strip_height], inverse[strip_height];
  int negative;  // pivots
  bool regular;  // every pivot is a number that can be divided by
};

// A front's dense matrix during the elimination; sizes as in Front.
struct OpenFront {
  double* columns;  // of the pivots, until they are columns of L
  double* update;
  double* factor;  // its part of L
  int first, pivots, pivot_height, height;
};

// A child's update and its runs that end in the columns it is added to, or after them.
struct ChildUpdate {
  const double* update;
  int height;
  const Run *begin, *end;
};

// A front's part of L and the places of its rows among the unknowns.
struct FrontFactor {
  const double* l;
  int first, pivots, pivot_strips, strips, below;
  const int* rows;
};

// One version's functions.
struct FrontKernels {
  // The number of strips of a tile of products.
  int tile_strips;

  // Writes the matrix' entries of the lower triangle in the pivots' columns [from, end).
  void (*assemble)(const OpenFront&, const Combination&, Entries, int from, int end);
  // Adds a child's update in the columns [from, end), all of pivots or none.
  void (*add_update)(const ChildUpdate&, const OpenFront&, int from, int end);

  // The next three work on the panel of pivots that begins at `from`. `scaled` holds the panel's
  // columns of L D in the rows of a tile, in strips of `panel` columns. Block i is the diagonal
  // block of strip i.
  void (*factorize_block)(const OpenFront&, int from, int i, const double* scaled, Block&);
  // Computes strips i, ... of L and L D in the panel's columns, those of strips [begin, end).
  void (*divide)(const OpenFront&, int from, int begin, int end, int i, int strips,
                 const Block* blocks, double* scaled);
  // Subtracts the part of pivots [from, end) from the strips i, ... after them. The first pivots
  // start the update.
  void (*subtract_from_rest)(const OpenFront&, int from, int end, int i, int strips,
                             const double* scaled);

  // Solves L z = b: puts the front's pivots of z into y, and subtracts their part from the rows
  // below.
  void (*forward)(const FrontFactor&, double* y, double* z);
  // Solves L' x = y: puts the front's pivots of x into y.
  void (*backward)(const FrontFactor&, double* y, double* x);
  // Both for four right-hand sides, rows of y; backwards() also divides by the pivots.
  void (*forwards)(const FrontFactor&, double* y, double* z);
  void (*backwards)(const FrontFactor&, const double* pivots, double* y, double* x);
};

// Returns the version in use.
const FrontKernels& front_kernels();

}  // namespace qddot::multifrontal
