#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace qddot {

// Who solves with the matrices a M - s K of implicit stages: the own multifrontal factorisation,
// CHOLMOD's to compare with, conjugate gradients without a factorisation, or whichever of the first
// and the last takes less work (see automatic_factors.hpp).
enum class Solver { automatic, multifrontal, cholmod, conjugate_gradients };

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

// Thrown where a numerical library gives up for a reason that no argument is to blame for; says so
// in a sentence. An integrator makes an outcome of it.
class SolverFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What became of a solve.
enum class SolveOutcome {
  found,
  indefinite,     // the matrix is not positive definite, and this solver needs it to be
  not_converged,  // too many iterations
};

}  // namespace qddot
