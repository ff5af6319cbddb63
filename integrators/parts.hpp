#pragma once

#include <memory>
#include <vector>

#include "integrators/integrator.hpp"

namespace qddot {

// Runs a system whose parts no force couples (System::parts): each by an integrator of its own,
// with steps of its own where the method is adaptive, as one run with one outcome. Counts are the
// sums over the parts. Where a part fails, the others are brought to the time that it reached.
class Parts final : public Integrator {
 public:
  Parts(const Method& method, const System& system, const Knobs& knobs);

 private:
  struct Piece {
    Index first;  // of its unknowns
    std::unique_ptr<Integrator> integrator;
    State state, begin;  // now, and where the present run_to began
  };

  void start(const State& state) override;
  Outcome run_to(State& state, double t_stop) override;

  void start(Piece& piece);
  // Brings the pieces to t_stop from where they are; the first failure ends it.
  Outcome run_all(double t_stop);
  // Brings all pieces to the time of the one that is behind, from `begin`.
  void step_back();
  void gather(State& state);

  std::vector<Piece> pieces_;
};

}  // namespace qddot
