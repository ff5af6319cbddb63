#pragma once

#include <vector>

#include "qddot/model/kernels/neighbour_slices.hpp"

namespace qddot::kernels {

// The slots of one shift that store tau/l of their springs, for the slots of the opposite shift,
// which are at most some slices later. Such a slot reads the values if it has exactly the same
// springs from their other ends.
//
// Forces are summed by blocks of slices, in two phases:
//   jobs    tau/l of all slots that store it, into the rings; no sum waits for a root or a quotient
//   terms   each node's sum of tau/l (x_j - x_i), in the order of its slots
struct Rings {
  std::vector<Ring> rings;
  std::vector<RingUse> uses;  // of the slots of one shift
  std::vector<RingJob> jobs;
  std::vector<int> job_dashpots;  // of each job, as NeighbourSlices::slot_dashpots
  std::vector<int> first_job;
  std::vector<RingTerm> terms;
  std::vector<int> first_term;
  int reach = 0;    // slices
  int numbers = 0;  // in the memory of all rings

  // Everything as kernels read it; valid as long as this.
  RingTable table() const {
    return {rings.data(), uses.data(),       jobs.data(), first_job.data(),
            terms.data(), first_term.data(), reach};
  }
};

Rings rings_of(const NeighbourSlices& slices);

}  // namespace qddot::kernels
