#include "qddot/model/vector_updates.hpp"

#include <array>
#include <cassert>

#include "qddot/model/kernels/vector_kernels.hpp"

namespace qddot {
namespace {

// The most stages that a table has.
constexpr std::size_t most_columns = 32;

void combine(const double* x, double d, const double* v, double c, const Eigen::MatrixXd& k,
             std::span<const double> b, double* out, Index n) {
  assert(std::ssize(b) <= k.cols() && b.size() <= most_columns);
  std::array<const double*, most_columns> columns;
  for (std::size_t j = 0; j < b.size(); ++j) {
    columns[j] = k.data() + static_cast<Index>(j) * k.outerStride();
  }
  kernels::vector_kernels().add_combination(x, d, v, c, columns.data(), b.data(),
                                            static_cast<int>(b.size()), out, n);
}

// The masses of the unknowns from the first one on.
kernels::Masses masses(const Mass& m, Index first = 0) {
  if (m.inverse().size() == 0) return {m.data() + first, nullptr, false};
  return {m.data() + first, m.inverse().data() + (m.is_uniform() ? 0 : first), m.is_uniform()};
}

}  // namespace

void add_scaled(const VecView& x, double c, const VecView& z, MutableVec out) {
  kernels::vector_kernels().add_scaled(x.data(), c, z.data(), out.data(), x.size());
}

void add_quotient(const VecView& x, Index first, Index end, double c, const VecView& f,
                  const Mass& m, MutableVec out) {
  kernels::vector_kernels().add_quotient(x.data() + first, c, f.data() + first, masses(m, first),
                                         out.data() + first, end - first);
}

void kick_and_drift(const Motion& motion, Index first, Index end, double c0, double c, double h,
                    MutableVec q_next, MutableVec w) {
  const auto& [q, v, f, m] = motion;
  kernels::vector_kernels().kick_and_drift(q.data() + first, v.data() + first, f.data() + first,
                                           masses(m, first), c0, c, h, q_next.data() + first,
                                           w.data() + first, end - first);
}

void half_kick_and_drift(const Motion& motion, Index first, Index end, double h, MutableVec q_next,
                         MutableVec w, MutableVec kicked) {
  const auto& [q, v, f, m] = motion;
  kernels::vector_kernels().half_kick_and_drift(
      q.data() + first, v.data() + first, f.data() + first, masses(m, first), h,
      q_next.data() + first, w.data() + first, kicked.data() + first, end - first);
}

void divide(const VecView& f, const Mass& m, MutableVec out) {
  kernels::vector_kernels().divide(f.data(), masses(m), out.data(), f.size());
}

void divide(const VecView& f, const VecView& m, MutableVec out) {
  kernels::vector_kernels().divide(f.data(), {m.data(), nullptr, false}, out.data(), f.size());
}

void multiply(const VecView& a, const VecView& b, MutableVec out) {
  kernels::vector_kernels().multiply(a.data(), b.data(), out.data(), a.size());
}

void add_combination(const VecView& x, double c, const Eigen::MatrixXd& k,
                     std::span<const double> b, MutableVec out) {
  combine(x.data(), 0, nullptr, c, k, b, out.data(), out.size());
}

void add_combination(const VecView& x, double d, const VecView& v, double c,
                     const Eigen::MatrixXd& k, std::span<const double> b, MutableVec out) {
  combine(x.data(), d, v.data(), c, k, b, out.data(), out.size());
}

void set_combination(double c, const Eigen::MatrixXd& k, std::span<const double> b,
                     MutableVec out) {
  combine(nullptr, 0, nullptr, c, k, b, out.data(), out.size());
}

void set_combination(std::span<const double* const> z, const double* b, MutableVec out) {
  kernels::vector_kernels().add_combination(nullptr, 0, nullptr, 1, z.data(), b,
                                            static_cast<int>(z.size()), out.data(), out.size());
}

void step_by_history(const HistoryStep& step, const VecView& f, const VecView& c, const VecView& q,
                     const VecView& d, MutableVec u_0, MutableVec d_next, MutableVec q_next) {
  kernels::vector_kernels().step_by_history(f.data(), c.data(), step.u.data(), step.r, step.b,
                                            static_cast<int>(step.u.size()) - 1, q.data(), d.data(),
                                            u_0.data(), d_next.data(), q_next.data(), f.size());
}

double squared_norm(const VecView& x) {
  return kernels::vector_kernels().squared_norm(x.data(), x.size());
}

double product(const VecView& a, const VecView& b) {
  return kernels::vector_kernels().product(a.data(), b.data(), a.size());
}

double product_with_sum(const VecView& a, const VecView& b, const VecView& c) {
  return kernels::vector_kernels().product_with_sum(a.data(), b.data(), c.data(), a.size());
}

double squared_norm_of_kicked(const VecView& v, Index first, Index end, double c, const VecView& f,
                              const Mass& m) {
  return kernels::vector_kernels().squared_norm_of_kicked(v.data() + first, c, f.data() + first,
                                                          masses(m, first), end - first);
}

double squared_error(const VecView& x, double rtol, const VecView& y, double atol) {
  return kernels::vector_kernels().squared_error(x.data(), rtol, y.data(), atol, x.size());
}

}  // namespace qddot
