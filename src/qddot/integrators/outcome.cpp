#include "qddot/integrators/outcome.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace qddot {
namespace {

// The names of outcomes and the advice on them, in the order of Outcome.
struct OutcomeWords {
  std::string_view name, advice;
};
constexpr OutcomeWords outcomes[] = {
    {"reached_end", ""},
    {"diverged", "the motion grew without bound: take a smaller step or an implicit method"},
    {"newton_failed", "the nonlinear solve of a step did not converge: take a smaller step"},
    {"indefinite_matrix",
     "M - h^2 K is not positive definite, as compressed springs make it: take a smaller step or an "
     "explicit method"},
    {"step_too_small",
     "the step is too small for the time to advance: take a larger step or tolerance, or an "
     "earlier end"},
    {"singular_mass",
     "a massless node has no acceleration: give it a mass or take a method that accepts massless "
     "nodes"},
    {"not_finite",
     "a force or velocity is not a finite number: take a smaller step, or look for extreme values "
     "in the scene"},
    {"solver_failed", "the solver gave up"},
    {"over_budget", "the run was stopped because its time was up"},
    {"stiffness_varies",
     "K changes with the positions, and this method is for constant K: take another one"},
    {"went_slack",
     "springs at a massless node came under compression, where they fold up in no time: give the "
     "node a mass; or on a scene of one dimension, where nothing folds up, keep it (--no-reduce "
     "massless) and take a method that accepts massless nodes"},
    {"no_stiff_set",
     "the scene names no stiff springs, whose forces this method takes apart: give it stiff_above, "
     "or take another method"},
    {"no_laplacian",
     "the system has no matrix that stands for its stiffness everywhere, as springs have: take "
     "another method"},
    {"no_stiffness",
     "the system computes no stiffness matrix K, which this method needs: give it "
     "stiffness_pattern() and stiffness(), or take an explicit method"},
    {"no_discrete_gradient",
     "the system computes no discrete gradient of its energy, which this method needs: take "
     "another method"},
    {"no_potential",
     "the system computes no potential V, whose energy this method keeps: give it one, or take "
     "another method"},
    {"not_conservative",
     "the forces depend on velocities, and this method is for forces of positions alone: take one "
     "for f(t, q, v), such as rk4"},
    {"refuses_damping",
     "the method would lose its order or its stability with this damping: take verlet, symmetric4, "
     "rk4 or an implicit method"},
    {"not_autonomous",
     "the forces depend on time, and this method is for forces that stay the same: take one for "
     "f(t, q), such as rk4"},
    {"no_constraints",
     "the scene has no rods, whose lengths this method keeps: take verlet, or kahan_li8"},
    {"refuses_constraints",
     "the scene has rods, whose lengths this method does not keep: take rattle, rattle4, rattle6, "
     "rattle8, arkode_erk8_rods or ida_rods"},
    {"chatters",
     "springs go slack, taut or break again and again while the time stands still: give them "
     "dashpots, or take verlet or an implicit method of order 2, which step over it"},
    {"unknown", ""}};  // any other number
constexpr std::size_t named_outcomes = std::size(outcomes) - 1;
static_assert(named_outcomes == static_cast<std::size_t>(Outcome::chatters) + 1);

const OutcomeWords& words_of(Outcome outcome) {
  return outcomes[std::min(static_cast<std::size_t>(outcome), named_outcomes)];
}

}  // namespace

std::string_view name(Outcome outcome) { return words_of(outcome).name; }
std::string_view advice(Outcome outcome) { return words_of(outcome).advice; }

std::optional<Outcome> find_outcome(std::string_view word) {
  for (std::size_t i = 0; i < named_outcomes; ++i) {
    if (outcomes[i].name == word) return static_cast<Outcome>(i);
  }
  return {};
}

}  // namespace qddot
