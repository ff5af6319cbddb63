#pragma once

#include <span>

#include "qddot/model/system.hpp"

// Updates of long vectors with the widest vectors of the processor, chosen at start. Eigen uses
// these only in code compiled for one processor. Sizes must agree; `out` may be an input.
namespace qddot {

// out = x + c z
void add_scaled(const VecView& x, double c, const VecView& z, MutableVec out);
// out = x + c f/m, entry by entry; of all unknowns or of [first, end).
void add_quotient(const VecView& x, Index first, Index end, double c, const VecView& f,
                  const Mass& m, MutableVec out);
inline void add_quotient(const VecView& x, double c, const VecView& f, const Mass& m,
                         MutableVec out) {
  add_quotient(x, 0, out.size(), c, f, m, out);
}
// Two kicks and a drift of the unknowns [first, end): w = (v + c0 f/m) + c f/m, `q_next` = q + h w.
struct Motion {
  const Vec &q, &v, &f;
  const Mass& m;
};
void kick_and_drift(const Motion& motion, Index first, Index end, double c0, double c, double h,
                    MutableVec q_next, MutableVec w);
inline void kick_and_drift(const Motion& motion, double c0, double c, double h, MutableVec q_next,
                           MutableVec w) {
  kick_and_drift(motion, 0, motion.q.size(), c0, c, h, q_next, w);
}
// Half a kick and a drift of the unknowns [first, end), and the velocity of a whole kick:
// w = v + h/2 f/m, `q_next` = q + h w and `kicked` = v + h f/m.
void half_kick_and_drift(const Motion& motion, Index first, Index end, double h, MutableVec q_next,
                         MutableVec w, MutableVec kicked);
// out = f/m and out = a b, entry by entry.
void divide(const VecView& f, const Mass& m, MutableVec out);
void divide(const VecView& f, const VecView& m, MutableVec out);
void multiply(const VecView& a, const VecView& b, MutableVec out);
// out = x + c K b, with as many first columns of K as b has entries, at most 32.
void add_combination(const VecView& x, double c, const Eigen::MatrixXd& k,
                     std::span<const double> b, MutableVec out);
// out = x + d v + c K b, likewise.
void add_combination(const VecView& x, double d, const VecView& v, double c,
                     const Eigen::MatrixXd& k, std::span<const double> b, MutableVec out);
// out = c K b
void set_combination(double c, const Eigen::MatrixXd& k, std::span<const double> b, MutableVec out);
// out_i = b_0 z_0i + b_1 z_1i + ...
void set_combination(std::span<const double* const> z, const double* b, MutableVec out);
// A step of a multistep method; u[1], u[2], ... are the u_1, u_2, ... of earlier steps:
//   u_0 = c f - (r_1 u_1 + r_2 u_2 + ...),   d' = d + b_0 u_0 + b_1 u_1 + ...,
//   q' = q + d',   c f entry by entry.
struct HistoryStep {
  std::span<const double* const> u;
  const double *r, *b;
};
void step_by_history(const HistoryStep& step, const VecView& f, const VecView& c, const VecView& q,
                     const VecView& d, MutableVec u_0, MutableVec d_next, MutableVec q_next);
// |x|^2
double squared_norm(const VecView& x);
// a.b and (a + b).c
double product(const VecView& a, const VecView& b);
double product_with_sum(const VecView& a, const VecView& b, const VecView& c);
// |v + c f/m|^2, of all unknowns or of [first, end).
double squared_norm_of_kicked(const VecView& v, Index first, Index end, double c, const VecView& f,
                              const Mass& m);
inline double squared_norm_of_kicked(const VecView& v, double c, const VecView& f, const Mass& m) {
  return squared_norm_of_kicked(v, 0, v.size(), c, f, m);
}
// The sum of (x_i/(rtol |y_i| + atol))^2: errors x of y in units of the tolerance, squared.
double squared_error(const VecView& x, double rtol, const VecView& y, double atol);

}  // namespace qddot
