// Newton's equations as SUNDIALS' users solve them: KLU on the sparse 2n x 2n matrix. Its entries
// are written at once in their places, so that SUNDIALS need not copy a Jacobian and add I to it.
#include <algorithm>

#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include "integrators/sundials/newton_matrix.hpp"
#include "integrators/sundials/support.hpp"
#include "qddot/model/first_order.hpp"

namespace qddot::sundials {
namespace {

class Klu final : public NewtonMatrix {
 public:
  Klu(const System& system, SUNContext context)
      : NewtonMatrix(context),
        mass_(system.mass()),
        pattern_(system),
        vector_(make_stock_vector(stacked_size(system), context)),
        entries_(check(SUNSparseMatrix(stacked_size(system), stacked_size(system),
                                       std::ssize(pattern_.rows()) + stacked_size(system) % 2,
                                       CSC_MAT, context))),
        klu_(check(SUNLinSol_KLU(vector_.get(), entries_.get(), context))) {
    std::ranges::copy(pattern_.column_starts(), SM_INDEXPTRS_S(entries_.get()));
    std::ranges::copy(pattern_.rows(), SM_INDEXVALS_S(entries_.get()));
    if (!has_work(vector_.get())) return;
    // Work has an entry on the diagonal.
    const auto count = std::ssize(pattern_.rows());
    SM_INDEXVALS_S(entries_.get())[count] = 2 * system.size();
    SM_INDEXPTRS_S(entries_.get())[2 * system.size() + 1] = count + 1;
  }

 private:
  void set_explicit_form(double gamma, const SymmetricMatrix& k,
                         const SymmetricMatrix* damping) override {
    s_ = -gamma * mass_.cwiseInverse();
    e_.setOnes();
    fill(1, -gamma, k, damping);
  }
  void fill(double alpha, double beta, const SymmetricMatrix& k, const SymmetricMatrix* damping) {
    pattern_.fill(alpha, beta, s_, k, e_, SM_DATA_S(entries_.get()), damping);
    if (has_work(vector_.get())) SM_DATA_S(entries_.get())[pattern_.rows().size()] = alpha;
  }
  void set_implicit_form(double c, const SymmetricMatrix& k,
                         const SymmetricMatrix* damping) override {
    s_.setConstant(-1);
    e_ = c * mass_;
    fill(c, -1, k, damping);
    for (Index i = 0; i < mass_.size(); ++i) {
      // The diagonal entry is the first of its column.
      if (mass_[i] == 0) SM_DATA_S(entries_.get())[pattern_.column_starts()[i]] = 0;
    }
  }

  void begin_run() override {
    NewtonMatrix::begin_run();
    has_pivots_ = false;
  }

  int factorize() override {
    const bool pivots = !has_pivots_ && content().symbolic;
    const int flag = pivots ? choose_pivots() : SUNLinSolSetup(klu_.get(), entries_.get());
    has_pivots_ = has_pivots_ || flag == SUN_SUCCESS;
    return flag;
  }

  // SUNDIALS keeps the pivots of its first factors. They suit the step sizes of that run and may
  // not suit the small steps at the start of the next. The symbolic analysis is the same for all.
  int choose_pivots() {
    sun_klu_free_numeric(&content().numeric, &content().common);
    content().numeric =
        sun_klu_factor(SM_INDEXPTRS_S(entries_.get()), SM_INDEXVALS_S(entries_.get()),
                       SM_DATA_S(entries_.get()), content().symbolic, &content().common);
    return content().numeric ? SUN_SUCCESS : SUN_ERR_EXT_FAIL;
  }

  int solve(N_Vector b, N_Vector x) override {
    return SUNLinSolSolve(klu_.get(), entries_.get(), x, b, 0);
  }

  _SUNLinearSolverContent_KLU& content() {
    return *static_cast<SUNLinearSolverContent_KLU>(klu_->content);
  }

  const Vec& mass_;
  FirstOrderPattern pattern_;
  Vec s_{mass_.size()}, e_{mass_.size()};  // of FirstOrderPattern::fill
  Vector vector_;
  Matrix entries_;
  LinearSolver klu_;
  bool has_pivots_ = false;
};

}  // namespace

std::unique_ptr<NewtonMatrix> make_klu(const System& system, SUNContext context, Solver) {
  return std::make_unique<Klu>(system, context);
}

}  // namespace qddot::sundials
