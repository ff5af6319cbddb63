#pragma once

#include <cstddef>

// The data that spring kernels read and write: plain numbers and pointers only. Their sources must
// not instantiate what other sources share, because the linker might keep the copy for wider
// vectors.
namespace qddot::kernels {

// The rows of a slice: the lanes of an AVX-512 vector. Every version uses this number, so that all
// processors add the springs of a node in the same order.
constexpr int slice_rows = 8;

// The start of a slice's slots; they end where those of the next slice begin.
struct Slice {
  int shift, gather;

  // The number of its first slot among all.
  constexpr int slot() const { return shift + gather / slice_rows; }
};

// The laws of a slot: the places of `slice_rows` numbers each among all laws' numbers.
struct SlotLaw {
  int stiffness, rest_length, quartic;
};

// The order of the unknowns of a slice: consecutive for all of its rows, consecutive for each row,
// or with coordinates that are no unknowns.
enum class Order { by_slice, by_row, none };

// The unknowns of a slice: their order and, where that is by slice, the first of them.
struct SliceUnknowns {
  Order order;
  int first;
};

// A ring buffer for tau/l of the springs of one shift, until the rows of their other ends follow.
// It holds the numbers of the last `mask` + 1 rows, a power of two; its first rows are repeated
// behind them.
struct Ring {
  int begin;  // in the memory of all rings
  int mask;
};

// The use of a ring by a slot of one shift: none, to store its numbers, or to read them.
struct RingUse {
  enum { none, keeps, finds } kind;
  int ring;
};

// A slot whose numbers a ring keeps. They are stored at the place `at` and, unless it is negative,
// at `copy`.
struct RingJob {
  int row, shift;  // its slice's first row
  SlotLaw law;
  int at, copy;
};

// A slot whose numbers stand in a ring: at begin + ((row + from) & mask) for a row and the next.
struct RingTerm {
  int shift, from, mask, begin;
};

// The rings of a network; see Rings.
struct RingTable {
  const Ring* rings;
  const RingUse* uses;    // of the slots of one shift
  const RingJob* jobs;    // slice after slice
  const int* first_job;   // of each slice, and the end
  const RingTerm* terms;  // each list of different terms once
  const int* first_term;  // of each slice, whose slots have a term each; -1: some has no ring
  int reach;              // the largest number of slices between a slot that reads and its source
};

// Slices are summed in blocks of this many where there are rings.
constexpr int slices_of_block = 8;

// The springs of a network; see NeighbourSlices and SpringsByNode.
struct SpringTable {
  const Slice* slices;
  const int* shifts;
  const int* gathers;        // where the points begin, see Positions
  const RingTable* rings;    // nullptr where there are none
  const SlotLaw* slot_laws;  // of all slots
  const double* laws;
  int law_vectors;
  const int* unknowns;  // D of each row; -1 - x for a coordinate that is x and no unknown
  const SliceUnknowns* slice_unknowns;
  const char* gathered;  // of the slices: whether any slot gathers from their rows
};

// Dashpots along the springs: places of `slice_rows` constants c [N s/m] among the laws' numbers.
struct DashpotTable {
  const int* slots;  // of all slots
  const int* jobs;   // of the rings' jobs
  // Behind the numbers of all rings their memory has as many for the dashpots, from here on.
  int first_number;
  // Whether no spring of rest length zero has one. Only such a dashpot can resist across its
  // spring.
  bool are_directed;
};

// A constant part of the forces: n numbers. If it is the same for all nodes, `of_slice` has it for
// the rows of one slice, else that is nullptr.
struct Offset {
  const double *all, *of_slice;
};

// Positions by coordinate and place and, if D > 1, point by point too.
struct Positions {
  double* coordinates;
  std::ptrdiff_t stride;  // from one coordinate to the next
  double* points;
};

// The distance between two of those points.
template <int D>
constexpr int point_stride = D == 1 ? 1 : 4;

// The places of K's values; see StiffnessKernel.
struct StiffnessTable {
  const int *slot_targets, *targets;
  const int* columns;  // D of each row
};

// The part of the tension that counts in K: compressed springs are scaled by `compression`, or
// springs with a rest length count none.
struct TensionPart {
  bool is_material;
  double compression;
};

// The way to a spring's length and to the quotient tau/l: by the processor's own root and division,
// by an estimate of the root, or by estimates of both. All give the same bits. See
// vectors/roots.hpp.
enum class Roots { processor, estimated_root, estimated };
constexpr int kinds_of_roots = 3;

// One version's functions for D dimensions; each works on the slices [from, end).
struct SpringKernels {
  // Copies the rows' coordinates at q to their places in the positions.
  void (*place)(const SpringTable&, const double* q, const Positions&, int from, int end);
  // f = offset + the forces of the rows' springs. `rings`: memory for all rings. It holds what
  // slices before `from` have stored if the call before this one ended there (`continues`).
  void (*force)(const SpringTable&, const Positions&, double* rings, bool continues, const Offset&,
                double* f, int from, int end);
  // Adds the energies of the rows' springs to `sums`: sums[r] is for row r of every slice. A spring
  // between two rows counts twice.
  void (*energy)(const SpringTable&, const Positions&, double* sums, int from, int end);
  // f = offset + the discrete gradients of the rows' springs between two positions.
  void (*mean_force)(const SpringTable&, const Positions& before, const Positions& after,
                     const Offset&, double* f, int from, int end);
  // Writes the rows' columns of K.
  void (*stiffness)(const SpringTable&, const Positions&, const StiffnessTable&, TensionPart,
                    double* values, int from, int end);
  // y = offset + K x of the rows, with x as `moved` has it and zero at fixed points.
  void (*stiffness_product)(const SpringTable&, const Positions&, const Positions& moved,
                            const Offset&, double* y, int from, int end);
  // sums = offset + the sums of |K_ij| over each row, and over blocks of fixed points, which K has
  // not.
  void (*stiffness_row_sums)(const SpringTable&, const Positions&, const Offset&, double* sums,
                             int from, int end);
  // friction = offset + the forces of the rows' dashpots. `velocities` are laid out as positions,
  // and zero at fixed points.
  void (*friction)(const SpringTable&, const DashpotTable&, const Positions&,
                   const Positions& velocities, const Offset&, double* friction, int from, int end);
  // The same, and f = offset_of_f + the forces of the rows' springs and dashpots, as force().
  // `met_no_length` is set where a spring with a dashpot has no length, and must be handed on like
  // `rings` then.
  void (*damped_force)(const SpringTable&, const DashpotTable&, const Positions&,
                       const Positions& velocities, double* rings, bool continues,
                       bool& met_no_length, const Offset& offset_of_f, double* f, const Offset&,
                       double* friction, int from, int end);
};

// Returns the version in use for 1, 2 or 3 dimensions; nullptr if it has no such roots.
const SpringKernels* spring_kernels(int dimension, Roots roots);

}  // namespace qddot::kernels
