#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "qddot/measure/trend/synthetic_errors.hpp"

namespace qddot::verdicts {

// How often something that is said with 95 % holds.
struct Coverage {
  int said = 0, held = 0;

  void add(bool holds) {
    ++said;
    held += holds;
  }
  // The part that holds, with its 95 % interval: Wilson, J. American Statistical Association 22
  // (1927) 209-212.
  Interval interval() const;
};

// The verdicts on errors of one kind.
struct Tally {
  std::map<Verdict, int> verdicts;
  std::map<std::string, Coverage> coverage;
  double walk = 0;  // mean size over the true one

  void add(const SyntheticKind& kind, const Trend& trend);
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Coverage, said, held)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Tally, verdicts, coverage, walk)

// "right", "wrong", or "uncertain" if the verdict claims nothing.
const char* judgement(const SyntheticKind& kind, Verdict verdict);

// The verdicts on `seeds` errors of that kind, each seen with so many cells in an octave. Throws
// Interrupted.
Tally tally(const SyntheticKind& kind, int seeds, int cells);

}  // namespace qddot::verdicts
