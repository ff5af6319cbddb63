#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace qddot {

// The solver for the matrices a M - s K of implicit stages: the project's own multifrontal
// factorisation, CHOLMOD's for comparison, or conjugate gradients without a factorisation.
// `automatic` takes the first or the last, whichever needs less work (automatic_factors.hpp).
enum class Solver { automatic, multifrontal, cholmod, conjugate_gradients };

// The names of all solvers, in the order of Solver.
inline constexpr std::array<std::pair<Solver, std::string_view>, 4> solver_names = {
    {{Solver::automatic, "automatic"},
     {Solver::multifrontal, "multifrontal"},
     {Solver::cholmod, "cholmod"},
     {Solver::conjugate_gradients, "conjugate_gradients"}}};

// Lists all names: "automatic, ...".
inline std::string solver_list() {
  std::string list;
  for (const auto& [solver, own] : solver_names)
    list += (list.empty() ? "" : ", ") + std::string(own);
  return list;
}

// The solver of that name, if there is one.
inline std::optional<Solver> find_solver(std::string_view name) {
  for (const auto& [solver, own] : solver_names) {
    if (own == name) return solver;
  }
  return {};
}

// The name of a solver.
constexpr std::string_view name(Solver solver) {
  return solver_names[static_cast<std::size_t>(solver)].second;
}

// Thrown when a numerical library fails although all arguments are allowed; what() is a sentence on
// it. An integrator turns it into an outcome.
class SolverFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The outcome of a solve.
enum class SolveOutcome {
  found,
  indefinite,     // the matrix is not positive definite, and this solver needs it to be
  not_converged,  // too many iterations
};

}  // namespace qddot
