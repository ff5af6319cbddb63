#include "integrators/sundials/support.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace qddot::sundials {
namespace {

// A run whose steps, so many in a row, are on the mean below this fraction of its length creeps up
// to a point that it will not pass.
constexpr int steps_in_a_row = 1000;
constexpr double smallest_mean_step = 1e-12;

Context make_context() {
  SUNContext context = nullptr;
  check(SUNContext_Create(nullptr, &context), "SUNContext_Create");
  return Context(context);
}

Matrix make_matrix(const FirstOrderPattern& pattern, Index n, SUNContext context) {
  const auto nonzeros = std::ssize(pattern.rows());
  Matrix matrix(check(SUNSparseMatrix(2 * n, 2 * n, nonzeros, CSC_MAT, context)));
  std::ranges::copy(pattern.column_starts(), SM_INDEXPTRS_S(matrix.get()));
  std::ranges::copy(pattern.rows(), SM_INDEXVALS_S(matrix.get()));
  return matrix;
}

}  // namespace

void check(int flag, const char* call) {
  if (flag < 0) throw std::runtime_error(fmt::format("{} failed with flag {}", call, flag));
}

Stock::Stock(const Method& method, const System& system, const Knobs& knobs)
    : Integrator(method, system, knobs),
      context_(make_context()),
      pattern_(system),
      y_(check(N_VNew_Serial(2 * system.size(), context()))),
      matrix_(make_matrix(pattern_, system.size(), context())),
      linear_solver_(check(SUNLinSol_KLU(y(), matrix(), context()))),
      q_(system.size()),
      f_(system.size()),
      k_(system.stiffness_pattern()) {}

void Stock::load(const State& state) {
  Halves halves(y());
  halves.q = state.q;
  halves.v = state.v;
}

void Stock::set_counts(const OwnCounts& own) {
  counts().steps = own.steps;
  counts().rejected = own.failed_tests + own.failed_solves;
  counts().factorizations = own.setups;
  counts().newton_iterations = counts().solves = own.iterations;
}

const Vec& Stock::force_at(const Eigen::Map<Vec>& q) {
  q_ = q;
  force(q_, f_);
  return f_;
}

void Stock::fill(SUNMatrix target, const Eigen::Map<Vec>& q, double alpha, double beta,
                 const Vec& s, const Vec& e) {
  q_ = q;
  stiffness(q_, k_);
  // SUNDIALS may have zeroed the pattern along with the values.
  std::ranges::copy(pattern_.column_starts(), SM_INDEXPTRS_S(target));
  std::ranges::copy(pattern_.rows(), SM_INDEXVALS_S(target));
  pattern_.fill(alpha, beta, s, k_, e, SM_DATA_S(target));
}

void Stock::keep_message(int, const char*, const char*, char* message, void* self) {
  try {
    static_cast<Stock*>(self)->said_ = message;
  } catch (...) {  // out of memory for a message: the flag alone has to do
  }
}

Outcome Stock::run_to(State& state, double t_stop) {
  parked_ = nullptr;
  said_.clear();
  set_stop_time(t_stop);
  try {
    const Outcome outcome = advance_steps(state, t_stop);
    collect_counts();
    return outcome;
  } catch (...) {
    collect_counts();
    throw;
  }
}

Outcome Stock::advance_steps(State& state, double t_stop) {
  const double creep = steps_in_a_row * smallest_mean_step * (t_stop - state.t);
  double t_mark = state.t;
  for (std::int64_t steps = 1; state.t < t_stop; ++steps) {
    if (must_stop()) return Outcome::over_budget;
    double t = state.t;
    const int flag = take_step(t_stop, t);
    if (parked_) std::rethrow_exception(parked_);
    if (flag < 0) return failure(flag, state.t);
    const Halves halves(y());
    if (!halves.q.allFinite() || !halves.v.allFinite()) return Outcome::not_finite;
    q_ = halves.q;
    if (!system().holds_at(q_)) return Outcome::went_slack;
    state.q = q_;
    state.v = halves.v;
    state.t = t;
    if (steps % steps_in_a_row != 0) continue;
    if (t - t_mark < creep) return Outcome::step_too_small;
    t_mark = t;
  }
  return Outcome::reached_end;
}

Outcome Stock::failure(int flag, double t) {
  const Outcome outcome = outcome_of(flag);
  std::ranges::replace(said_, '\n', ' ');
  explain(fmt::format("{} at t = {:.6g} s: {}{}", flag_name(flag), t, advice(outcome),
                      said_.empty() ? "" : fmt::format(" ({})", said_)));
  return outcome;
}

}  // namespace qddot::sundials
