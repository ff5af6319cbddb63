#pragma once

#include <optional>

#include "qddot/algebra/laplacian_mass.hpp"
#include "qddot/integrators/base/fixed_steps.hpp"

namespace qddot {

// Implicit Euler as a minimisation over the velocity, in a given number of iterations with a
// constant metric:
//   g(v) = 1/2 (v - v_n)' M (v - v_n) + V(q_n + h v)
//   r    = dg/dv = M (v - v_n) - h f(q_n + h v)
//   p    = (M + h^2 L)^-1 r
// The iterations start from the inertial prediction v = v_n. One iteration of local_global is
// v = v - p; other methods use the same r and p in their own ways. The matrix is factorised once a
// step size.
//
// A dashpot c is a spring within the step, of the rate l' = (l(q_n + h v) - l(q_n))/h. It adds h/2
// c l'^2 to g, which so stays a minimisation, and h times the constant matrix that bounds C to the
// metric. A system that knows no lengths has h/2 v'C(q_n)v.
class LocalGlobal : public Formula {
 public:
  explicit LocalGlobal(SystemRun& run);
  virtual ~LocalGlobal() = default;

  void begin(const State& state, State& x) {
    x = state;
    factorized_h_ = 0;
  }
  Outcome step(const State& now, double h, State& next);

 protected:
  // Called before the first iteration of each step.
  virtual void begin_step() {}
  // Brings v one iteration further, with one gradient() and one direction().
  virtual void iterate(Vec& v) = 0;

  int iterations() const { return iterations_; }
  double step_size() const { return h_; }
  // Whether L bounds -K, so that g falls by at least r'p / 2 from v to v - p.
  bool descends() const { return descends_; }
  // Compute r at v and p from r, as above.
  void gradient(const Vec& v, Vec& r);
  void direction(const Vec& r, Vec& p);
  double objective(const Vec& v);  // g [J]
  // Sets friction_ where the step ends with v, and returns the power that it takes [W].
  double find_friction(const Vec& v);
  // The power [W] of friction and driving at the end of a step with the velocity v.
  Work power_at(const Vec& v);
  // Moves v by the first of -p, -p/2, -p/4, ... that lowers g by Armijo's rule, or not at all if
  // rounding hides it. `g` is that of v, before and after.
  void search(Vec& v, const Vec& p, double slope, double& g);
  // Moves v by -p if that is sure to lower g, else by search().
  void plain_step(Vec& v, const Vec& r, const Vec& p);

 private:
  int iterations_;
  bool descends_;
  std::optional<LaplacianMass> matrix_;
  const State* now_ = nullptr;               // the start of the present step
  double t_ = 0, h_ = 0, factorized_h_ = 0;  // t_: of its end [s]
  bool is_finite_ = true;                    // whether the last direction is finite
  Vec q_{system().size()}, f_{system().size()}, trial_{system().size()};
  Vec friction_;  // n if the system has Damping
};

}  // namespace qddot
