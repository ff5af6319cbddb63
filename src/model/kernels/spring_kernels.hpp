#pragma once

#include <cstddef>

// What the kernels of springs read and write: plain numbers and pointers alone, for their sources
// must not instantiate what others share; the linker might keep the copy for wider vectors.
namespace qddot::kernels {

// Where a slice's slots begin; they end where those of the next begin.
struct Slice {
  int shift, gather;
  std::ptrdiff_t law;
};

// How the coordinates of a slice's rows stand among the unknowns: all of them follow one another,
// those of each row do, or some are no unknowns.
enum class Order { by_slice, by_row, none };

// The springs of a network; see NeighbourSlices and SpringsByNode.
struct SpringTable {
  const Slice* slices;
  const int *shifts, *gathers;
  const double* laws;
  int law_vectors;
  const int* unknowns;   // D of each row
  const Order* orders;   // of the slices
  const char* gathered;  // of the slices: whether any slot gathers from their rows
};

// Where everything is, by place and coordinate and, where D > 1, by point, too.
struct Positions {
  double* coordinates;
  std::ptrdiff_t stride;  // from one coordinate to the next
  double* points;
};

// How far apart those points are.
template <int D>
constexpr int point_stride = D == 1 ? 1 : 4;

// Where K's values go; see StiffnessKernel.
struct StiffnessTable {
  const int *slot_targets, *targets;
  const int* columns;  // D of each row
};

// Which part of the tension counts in K: what is compressed, scaled by `compression`, or none of a
// spring that has a rest length.
struct TensionPart {
  bool is_material;
  double compression;
};

// One version's functions for D dimensions; each works on the slices [from, end).
struct SpringKernels {
  int lanes;  // of a vector, and rows of a slice

  // Puts the rows' coordinates at q where they are looked up.
  void (*place)(const SpringTable&, const double* q, const Positions&, int from, int end);
  // f = offset + the forces of the rows' springs.
  void (*force)(const SpringTable&, const Positions&, const double* offset, double* f, int from,
                int end);
  // Writes the rows' columns of K.
  void (*stiffness)(const SpringTable&, const Positions&, const StiffnessTable&, TensionPart,
                    double* values, int from, int end);
};

// Returns the version in use for 1, 2 or 3 dimensions.
const SpringKernels& spring_kernels(int dimension);

}  // namespace qddot::kernels
