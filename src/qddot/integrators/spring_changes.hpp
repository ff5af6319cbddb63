#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "qddot/model/capabilities.hpp"

namespace qddot {

// A spring that broke.
struct Break {
  double t = 0;       // [s]
  Index number = 0;   // among the system's springs that change their phases (Switching)
  double strain = 0;  // (l - l0)/l0, there
  double energy = 0;  // that it held [J]
};

// Whether a method of that order, 0 for one without error, steps over moments at which cables of
// the system go slack or taut, since their jumps change a step across them by no more than its
// order.
bool steps_over_slack(int order, const System& system);

// Finds the moments of a run at which springs go slack, taut, or break, and keeps their phases.
//
// In a step all springs stay in their phases, so that forces are smooth. If a step passes the end
// of a phase, a shorter one is taken from the same start, up to the moment that a cubic in time
// gives. Newton's method finds the moment from there, by the length and its rate at the end of each
// try: a try that ends before the moment is kept, one beyond it is not. So the moment has the error
// of the method's own steps, and there is no other interpolation.
//
// Methods whose order does not see a jump in the derivative of f step over slack cables: a cable
// then pulls by its length at each evaluation. All methods find breakings.
class SpringChanges {
 public:
  // `order`: of the method; 0 for one without error. `rtol`: its tolerance, 0 for one of fixed
  // steps. Borrows the system.
  SpringChanges(const System& system, int order, double rtol);

  // Whether springs may change their phases at all.
  bool are_possible() const { return switching_; }
  // The phases now; nullptr if none changes.
  const Phase* phases() const { return switching_ ? phases_.data() : nullptr; }
  const std::vector<Break>& breaks() const { return breaks_; }
  std::int64_t count() const { return count_; }

  // Forgets all of an earlier run.
  void clear();
  // Begins at `state`, with its phases and those of cables by its lengths. What was after it is
  // forgotten.
  void begin(const State& state);
  // Whether the step passes the end of a phase. If it will not be accepted for that reason, call
  // aim(), which makes this the one that is looked for.
  bool passes_end(const State& from, const State& to);
  void aim();

  // The moment that is looked for [s], if there is one; and the accepted state before it.
  bool is_looking() const { return target_.has_value(); }
  double moment() const { return target_->t; }
  const State& before() const { return before_; }
  // Whether that state is at the moment, within rounding.
  bool is_at_moment() const;

  enum class Landing { changed, closer, beyond, missed, endless };
  // Takes `state`, the end of a step at the moment. If the phase ends there within rounding, this
  // changes the phases, books the energy of springs that break in `state`, and looks no longer.
  // Else the moment is now a later one from `state` on (closer), or an earlier one after before()
  // (beyond); or no phase ends there (missed). `endless`: changes follow one another in no time.
  Landing land(State& state);
  // The phases for State::phases.
  const std::shared_ptr<const std::vector<Phase>>& broken() const { return broken_; }

 private:
  void change(const Switching::Change& change, State& state);
  bool goes_back_for_others(const At& at);

  const Switching* switching_;
  double rtol_;
  bool finds_slack_ = false;
  std::vector<Phase> phases_;
  std::shared_ptr<const std::vector<Phase>> broken_;  // nullptr if none is
  std::optional<Switching::Change> passed_, target_;
  State before_passed_, before_;
  int tries_ = 0;
  double last_ = 0;    // [s], of the last change
  Index at_once_ = 0;  // landings since then, at the same time
  std::vector<Break> breaks_;
  std::int64_t count_ = 0;
  std::vector<Switching::Change> due_;
  std::vector<char> has_changed_;
};

}  // namespace qddot
