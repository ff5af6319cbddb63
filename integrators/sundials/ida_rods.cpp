// SUNDIALS IDA on the equations of motion with constraints, in the stabilised form of index 2:
//   0 = q' - v + G'mu          0 = g(t, q)
//   0 = M v' - f + G'lambda    0 = G v + dg/dt
// Source: Gear, Leimkuhler, Gupta, J. Computational and Applied Mathematics 12-13 (1985) 77-90. The
// exact motion has mu = 0; so both constraints are kept, where index 3 loses order and index 1
// drifts. BDF and its steps are as in ida.cpp.
//
// The vector is y = (q, mu, v, lambda). The multipliers stay out of the error test, and of the test
// of Newton's iteration: mu and lambda have one order less than q and v. Newton's matrix is the
// Jacobian of all of it, dF/dy + c dF/dy', with H(x) = sum x_k d2g_k/dq2 and the rates G':
//   [ c I + H(mu)      G'   -I          0  ]
//   [ G                0     0          0  ]
//   [ -K + H(lambda)   0     c M + C    G' ]
//   [ dG/dt            0     G          0  ]
// KLU factorises it, sparse and with its rows scaled.
#include <algorithm>

#include <fmt/format.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include "integrators/sundials/ida_stepper.hpp"
#include "qddot/algebra/multipliers.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {
namespace {

using namespace sundials;

// The tolerance of what decides no step; its inverse is no subnormal number.
constexpr double unlimited = 1e200;

class IdaRods final : public IdaStepper {
  using Columns = Eigen::SparseMatrix<double, Eigen::ColMajor, sunindextype>;

 public:
  explicit IdaRods(SystemRun& run)
      : IdaStepper(run, length_of(run.system())),
        n_(system().size()),
        constraints_(system().constraints()),
        multipliers_(system()),
        curvatures_(constraints_ ? constraints_->curvatures() : std::vector<Curvature>()),
        gradients_(multipliers_.gradients()),
        g_(multipliers_.count()),
        k_(system().stiffness_pattern()) {
    if (system().damping()) c_ = k_;
    Halves absolute(atol());
    absolute.q.tail(g_.size()).setConstant(unlimited);
    absolute.v.tail(g_.size()).setConstant(unlimited);
    find_places();
    matrix_.reset(check(SUNSparseMatrix(jacobian_.rows(), jacobian_.cols(), jacobian_.nonZeros(),
                                        CSC_MAT, context())));
    write_jacobian(matrix_.get());
    klu_.reset(check(SUNLinSol_KLU(y(), matrix_.get(), context())));
    keep({residual, set_jacobian, klu_.get(), matrix_.get()});
  }

 private:
  using Curvature = Constraints::Curvature;

  static Index length_of(const System& system) {
    const Constraints* constraints = system.constraints();
    return stacked_size(system) + 2 * (constraints ? constraints->constraint_count() : 0);
  }
  At place(double t, const Halves& y) {
    return run_.counted().placed({t, VecView(y.q.data(), n_), VecView(y.v.data(), n_)});
  }

  void start(const State& state) override {
    load(state);
    forget();
    Halves at(y()), change(rate());
    at.q.tail(g_.size()).setZero();
    change.q.setZero();
    change.v.setZero();
    f_.resize(n_);
    force(state, f_);
    multipliers_.take_gradients(place(state.t, at));
    is_regular_ = multipliers_.factorize();
    if (is_regular_) at.v.tail(g_.size()) = multipliers_.forces_at(place(state.t, at), f_);
    change.q.head(n_) = state.v;
    if (constraints_) f_.noalias() -= multipliers_.gradients().transpose() * at.v.tail(g_.size());
    change.v.head(n_) = f_.cwiseQuotient(system().mass());
    if (has_work(y())) sundials::work(rate()) = taken(state.t, at);
    start_ida(state.t);
  }

  int take_step(double t_stop, double& t) override {
    if (!is_regular_) return IDA_LSETUP_FAIL;
    return IDASolve(ida(), t_stop, &t, y(), rate(), IDA_ONE_STEP);
  }

  // The power of friction less that of driving, at the place of the last force.
  double taken(double t, const Halves& at) {
    double sum = power().taken();
    if (constraints_ && is_driven()) {
      constraints_->constraint_rates(place(t, at), g_);
      sum -= g_.dot(at.v.tail(g_.size()));
    }
    return sum;
  }
  double driving_rate(const At& at) override {
    const double own = Library::driving_rate(at);
    if (!constraints_) return own;
    const At there = run_.counted().placed(at);
    Vec f(n_), rates(g_.size());
    system().force(there, f);
    multipliers_.take_gradients(there);
    multipliers_.factorize();
    constraints_->constraint_rates(there, rates);
    return own + rates.dot(multipliers_.forces_at(there, f));
  }

  static int residual(double t, N_Vector y, N_Vector rate, N_Vector residual, void* user) {
    auto& self = *static_cast<IdaRods*>(static_cast<Library*>(user));
    return self.guarded([&] { return self.set_residual(t, y, rate, residual); });
  }

  bool set_residual(double t, N_Vector y, N_Vector rate, N_Vector residual) {
    const Halves at(y), change(rate);
    Halves out(residual);
    const At here = place(t, at);
    const Index m = g_.size();
    force(here, f_);
    out.q.head(n_) = change.q.head(n_) - at.v.head(n_);
    out.v.head(n_) = system().mass().cwiseProduct(change.v.head(n_)) - f_;
    if (constraints_) {
      constraints_->constraint_gradients(here, gradients_);
      out.q.head(n_).noalias() += gradients_.transpose() * at.q.tail(m);
      out.v.head(n_).noalias() += gradients_.transpose() * at.v.tail(m);
      constraints_->constraint_values(here, g_);
      out.q.tail(m) = g_;
      constraints_->constraint_rates(here, g_);
      out.v.tail(m) = g_;
      out.v.tail(m).noalias() += gradients_ * at.v.head(n_);
    }
    if (has_work(y)) sundials::work(residual) = sundials::work(rate) - taken(t, at);
    return std::isfinite(out.v.sum());
  }

  static int set_jacobian(double t, double c, N_Vector y, N_Vector, N_Vector, SUNMatrix matrix,
                          void* user, N_Vector, N_Vector, N_Vector) {
    auto& self = *static_cast<IdaRods*>(static_cast<Library*>(user));
    return self.guarded([&] {
      self.jacobian_.coeffs().setZero();
      double* values = self.jacobian_.valuePtr();
      const int* place = self.places_.data();
      self.for_entries(t, c, Halves(y),
                       [&](Index, Index, double value) { values[*place++] += value; });
      self.write_jacobian(matrix);
      return true;
    });
  }

  // IDA has cleared the pattern as well.
  void write_jacobian(SUNMatrix matrix) {
    std::copy_n(jacobian_.outerIndexPtr(), jacobian_.cols() + 1, SM_INDEXPTRS_S(matrix));
    std::copy_n(jacobian_.innerIndexPtr(), jacobian_.nonZeros(), SM_INDEXVALS_S(matrix));
    std::copy_n(jacobian_.valuePtr(), jacobian_.nonZeros(), SM_DATA_S(matrix));
  }

  // Makes the pattern of the Jacobian, and finds the place of each entry that for_entries() names.
  void find_places() {
    std::vector<Eigen::Triplet<double>> entries;
    const auto list = [&](Index row, Index column, double) {
      entries.emplace_back(row, column, 0);
    };
    for_entries(0, 1, Halves(y()), list);
    jacobian_.resize(N_VGetLength(y()), N_VGetLength(y()));
    jacobian_.setFromTriplets(entries.begin(), entries.end());
    const sunindextype *first = jacobian_.outerIndexPtr(), *rows = jacobian_.innerIndexPtr();
    for (const auto& entry : entries) {
      const auto* place =
          std::lower_bound(rows + first[entry.col()], rows + first[entry.col() + 1], entry.row());
      places_.push_back(static_cast<int>(place - rows));
    }
  }

  // Calls see(row, column, value) for the summands of the Jacobian's entries, always in one order.
  template <class See>
  void for_entries(double t, double c, const Halves& at, const See& see) {
    const At here = place(t, at);
    const Index m = g_.size(), v = n_ + m;  // the first velocity, and the first row of M v'
    const auto see_both = [&](Index row, Index column, Index i, Index j, double value) {
      see(row + i, column + j, value);
      if (i != j) see(row + j, column + i, value);
    };
    for (Index i = 0; i < n_; ++i) {
      see(i, i, c);
      see(i, v + i, -1);
      see(v + i, v + i, c * system().mass()[i]);
    }
    stiffness(here, k_);
    if (c_.size() > 0) system().damping()->damping_matrix(here, c_);
    for (Index j = 0; j < n_; ++j) {
      for (SymmetricMatrix::InnerIterator k(k_, j); k; ++k) see_both(v, 0, k.row(), j, -k.value());
      if (c_.size() == 0) continue;
      for (SymmetricMatrix::InnerIterator d(c_, j); d; ++d) see_both(v, v, d.row(), j, d.value());
    }
    for (const Curvature& one : curvatures_) {
      see_both(0, 0, one.i, one.j, at.q[n_ + one.k] * one.value);
      see_both(v, 0, one.i, one.j, at.v[n_ + one.k] * one.value);
    }
    if (constraints_) {
      constraints_->constraint_gradients(here, gradients_);
      for_each(gradients_, [&](Index k, Index i, double value) {
        see(i, n_ + k, value);
        see(n_ + k, i, value);
        see(v + i, v + n_ + k, value);
        see(v + n_ + k, v + i, value);
      });
      constraints_->gradient_rates(here, gradients_);
      for_each(gradients_, [&](Index k, Index i, double value) { see(v + n_ + k, i, value); });
    }
    if (has_work(y())) see(2 * v, 2 * v, c);
  }

  template <class See>
  static void for_each(const GradientMatrix& gradients, const See& see) {
    for (Index k = 0; k < gradients.rows(); ++k) {
      for (GradientMatrix::InnerIterator at(gradients, k); at; ++at) see(k, at.col(), at.value());
    }
  }

  Index n_;
  const Constraints* constraints_;  // nullptr in a part without
  Multipliers multipliers_;
  std::vector<Curvature> curvatures_;
  GradientMatrix gradients_;
  Vec f_, g_;
  SymmetricMatrix k_, c_;
  std::vector<int> places_;  // in the Jacobian, of its summands
  Columns jacobian_;
  bool is_regular_ = true;
  Matrix matrix_;
  LinearSolver klu_;
};

}  // namespace

Method ida_rods() {
  return {.name = "ida_rods",
          .summary = "SUNDIALS IDA with rods: BDF of order 1 to 5 in the form of index 2, with KLU",
          .source =
              "Gear, Leimkuhler, Gupta, J. Computational and Applied Mathematics 12-13 "
              "(1985) 77-90",
          .order = 5,
          .family = Family::sundials,
          .knob = Knob::rtol,
          .traits = {Trait::implicit},
          .needs = {Need::conservative, Need::constraints, Need::stiffness},
          .takes = {Option::max_order},
          .damped = Damped::by_any,
          .make = create_steps<IdaRods>};
}

}  // namespace qddot::registered
