#include "qddot/algebra/multipliers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "qddot/algebra/factors.hpp"
#include "qddot/model/machine_epsilon.hpp"

namespace qddot {

Multipliers::Multipliers(const System& system)
    : system_(system), constraints_(system.constraints()) {
  if (!constraints_) return;
  per_mass_ = system.mass().cwiseInverse();
  gradients_ = constraints_->gradient_pattern();
  const Index m = gradients_.rows();
  right_.resize(m);
  lambda_.resize(m);
  for (const Constraints::Curvature& curvature : constraints_->curvatures()) {
    longest_ = std::max(longest_, 1 / std::abs(curvature.value));
  }

  // For each unknown, the values of G in its column, by rows.
  struct Value {
    int row, place;
  };
  std::vector<std::vector<Value>> columns(static_cast<std::size_t>(system.size()));
  const int* unknowns = gradients_.innerIndexPtr();
  for (int row = 0; row < m; ++row) {
    for (int e = gradients_.outerIndexPtr()[row]; e < gradients_.outerIndexPtr()[row + 1]; ++e) {
      columns[static_cast<std::size_t>(unknowns[e])].push_back({row, e});
    }
  }
  struct Entry {
    int column, row;
    Term term;
  };
  std::vector<Entry> entries;
  for (const std::vector<Value>& column : columns) {
    for (std::size_t b = 0; b < column.size(); ++b) {
      for (std::size_t a = b; a < column.size(); ++a) {
        entries.push_back({column[b].row,
                           column[a].row,
                           {column[a].place, column[b].place, unknowns[column[a].place]}});
      }
    }
  }
  const auto place = [](const Entry& entry) { return std::pair(entry.column, entry.row); };
  std::ranges::stable_sort(entries, {}, place);
  std::vector<Eigen::Triplet<double>> pattern;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (e == 0 || place(entries[e]) != place(entries[e - 1])) {
      first_term_.push_back(static_cast<int>(e));
      pattern.emplace_back(entries[e].row, entries[e].column, 0);
    }
    terms_.push_back(entries[e].term);
  }
  first_term_.push_back(static_cast<int>(terms_.size()));
  matrix_.resize(m, m);
  matrix_.setFromTriplets(pattern.begin(), pattern.end());
  factors_ = make_multifrontal(matrix_, Vec::Zero(m));
}

Multipliers::~Multipliers() = default;

void Multipliers::take_gradients(const At& at) {
  if (constraints_) constraints_->constraint_gradients(at, gradients_);
}

bool Multipliers::factorize(double s) {
  if (!constraints_) return true;
  const double* g = gradients_.valuePtr();
  for (std::size_t entry = 0; entry + 1 < first_term_.size(); ++entry) {
    double sum = 0;
    for (int t = first_term_[entry]; t < first_term_[entry + 1]; ++t) {
      const Term& term = terms_[static_cast<std::size_t>(t)];
      sum += g[term.a] * g[term.b] * per_mass_[term.unknown];
    }
    matrix_.valuePtr()[entry] = sum;
  }
  for (Index k = 0; s > 0 && k < matrix_.cols(); ++k) {
    // The diagonal entry is the first of its column.
    matrix_.valuePtr()[matrix_.outerIndexPtr()[k]] += s * constraints_->compliances()[k];
  }
  return factors_->factorize_positive(0, -1, matrix_);
}

void Multipliers::solve(const Vec& b, Vec& x) {
  if (constraints_) {
    factors_->solve(b, x);
  } else {
    x.resize(0);
  }
}

void Multipliers::add_pull(double s, const Vec& x, Vec& v) const {
  if (!constraints_) return;
  const int* unknowns = gradients_.innerIndexPtr();
  const int* first = gradients_.outerIndexPtr();
  const double* g = gradients_.valuePtr();
  for (Index row = 0; row < gradients_.rows(); ++row) {
    const double pull = s * x[row];
    for (int e = first[row]; e < first[row + 1]; ++e) {
      v[unknowns[e]] += pull * per_mass_[unknowns[e]] * g[e];
    }
  }
}

const Vec& Multipliers::forces_at(const At& at, const ConstVec& f) {
  if (!constraints_) return lambda_;
  constraints_->constraint_accelerations(at, right_);
  const int* unknowns = gradients_.innerIndexPtr();
  for (Index row = 0; row < gradients_.rows(); ++row) {
    for (int e = gradients_.outerIndexPtr()[row]; e < gradients_.outerIndexPtr()[row + 1]; ++e) {
      right_[row] += gradients_.valuePtr()[e] * per_mass_[unknowns[e]] * f[unknowns[e]];
    }
  }
  solve(right_, lambda_);
  return lambda_;
}

const Vec& Multipliers::project_velocities(const At& at, Vec& v) {
  if (!constraints_) return lambda_;
  constraints_->constraint_rates(at, right_);
  right_.noalias() += gradients_ * v;
  solve(right_, lambda_);
  add_pull(-1, lambda_, v);
  return lambda_;
}

double Multipliers::rounding(const VecView& q) const {
  return 2 * machine_epsilon * std::max(q.lpNorm<Eigen::Infinity>(), longest_);
}

bool Multipliers::project(At at, Vec& q, Vec& v) {
  if (!constraints_) return true;
  constexpr int most_iterations = 10;
  const double enough = rounding(q);
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_iterations; ++i) {
    At here(at.t, q, v);
    here.within = at.within;
    here.phases = at.phases;
    take_gradients(here);
    if (!factorize()) return false;
    constraints_->constraint_values(here, right_);
    const double worst = right_.lpNorm<Eigen::Infinity>();
    if (worst <= enough || worst > last / 2) {
      project_velocities(here, v);
      return worst <= 32 * enough;
    }
    last = worst;
    solve(right_, lambda_);
    add_pull(-1, lambda_, q);
  }
  return false;
}

}  // namespace qddot
