#pragma once

#include <cmath>
#include <complex>
#include <limits>
#include <type_traits>

#include <Eigen/Core>

namespace qddot {

// The law of a plain spring of length l >= 0: V(l) = 1/2 k (l - l0)^2 + 1/4 c (l - l0)^4.
// k = 2 kappa / l0^2 gives the lecture's V = kappa (1 - l/l0)^2.
struct PlainLaw {
  double stiffness = 0;    // k [N/m], >= 0
  double rest_length = 0;  // l0 [m], >= 0
  double quartic = 0;      // c [N/m^3], >= 0
  double damping = 0;      // of a dashpot along the spring [N s/m], >= 0

  // V(l) [J].
  template <class Real>
  Real energy(Real l) const {
    const Real s = l - rest_length, s2 = s * s;
    return s2 * (0.5 * stiffness + 0.25 * quartic * s2);
  }
  // tau = dV/dl [N], positive in tension.
  template <class Real>
  Real tension(Real l) const {
    const Real s = l - rest_length;
    return s * (stiffness + quartic * s * s);
  }
  // (V(b) - V(a))/(b - a) [N], in a form that does not cancel; tension(a) where a = b.
  double secant(double a, double b) const {
    const double s = a - rest_length, t = b - rest_length;
    return 0.5 * (s + t) * (stiffness + 0.5 * quartic * (s * s + t * t));
  }
  // d tau / dl [N/m].
  template <class Real>
  Real tangent(Real l) const {
    const Real s = l - rest_length;
    return stiffness + 3.0 * quartic * s * s;
  }
};

// The law of any spring: V(l) = 1/2 k (l - l0)^2 + 1/3 b (l - l0)^3 + 1/4 c (l - l0)^4. A cable
// (`pulls_only`) has V = 0 where l < l0, and its dashpot acts where l >= l0. The functions below
// know no breaking.
struct SpringLaw {
  double stiffness = 0;    // k [N/m], >= 0
  double rest_length = 0;  // l0 [m], >= 0
  double quartic = 0;      // c [N/m^3], >= 0
  double damping = 0;      // of a dashpot along the spring [N s/m], >= 0
  double cubic = 0;        // b [N/m^2], of any sign
  // The strain (l - l0)/l0 > 0 at which it breaks.
  double breaks_at = std::numeric_limits<double>::infinity();
  bool pulls_only = false;
  // Whether it is a rod: its length stays l0 > 0. A rod has no energy and no force of its own;
  // multipliers keep its length (see Constraints). All other numbers are zero, but for the check of
  // a rod that stands for a spring: then `stiffness` is the spring's.
  bool rigid = false;

  // A cable of rest length zero is never slack.
  bool goes_slack() const { return pulls_only && rest_length > 0; }
  bool can_break() const { return std::isfinite(breaks_at); }
  bool is_plain() const { return cubic == 0 && !goes_slack() && !can_break() && !rigid; }
  // Whether it is a spring that is not plain.
  bool is_general() const { return !is_plain() && !rigid; }
  PlainLaw plain() const { return {stiffness, rest_length, quartic, damping}; }
  // Whether the force is linear in the difference of the spring's ends.
  bool is_linear() const { return rest_length == 0 && quartic == 0 && cubic == 0 && !can_break(); }
  bool is_slack(double l) const { return goes_slack() && l < rest_length; }

  // V(l) [J].
  template <class Real>
  Real energy(Real l) const {
    const Real s = l - rest_length, s2 = s * s;
    if (is_slack(std::real(l))) return Real(0);
    return s2 * (0.5 * stiffness + cubic / 3 * s + 0.25 * quartic * s2);
  }
  // tau = dV/dl [N], positive in tension.
  template <class Real>
  Real tension(Real l) const {
    const Real s = l - rest_length;
    if (is_slack(std::real(l))) return Real(0);
    return s * (stiffness + cubic * s + quartic * s * s);
  }
  // (V(b) - V(a))/(b - a) [N], in a form that does not cancel; tension(a) where a = b.
  double secant(double a, double b) const {
    // A slack end has the energy of the rest length, and a quotient of its own.
    if (is_slack(a) || is_slack(b)) return a == b ? 0 : (energy(b) - energy(a)) / (b - a);
    const double s = a - rest_length, t = b - rest_length;
    return 0.5 * (s + t) * (stiffness + 0.5 * quartic * (s * s + t * t)) +
           cubic / 3 * (s * s + s * t + t * t);
  }
  // d tau / dl [N/m].
  template <class Real>
  Real tangent(Real l) const {
    const Real s = l - rest_length;
    if (is_slack(std::real(l))) return Real(0);
    return stiffness + 2 * cubic * s + 3.0 * quartic * s * s;
  }
};

// The state of a spring that may go slack or break. `by_length`: a cable pulls where it is longer
// than its rest length, and nothing else is known of it. `taut`: it pulls, and its law is continued
// to smaller lengths. So the force stays smooth in a step up to the moment at which it goes slack.
enum class Phase : char { by_length, taut, slack, broken };

// The validity of a spring's law: always, or in tension only, l >= l0. The second is for a spring
// that replaces several in series through massless nodes. They fold up in compression, where this
// one would push.
enum class Holds : unsigned char { always, in_tension };

// Functions of one spring between x_i and x_j in D = 1, 2 or 3 dimensions: d = x_j - x_i [m],
// l = |d|, n = d/l. Real is double, or std::complex<double> for complex-step differentiation.
//
// The direction n does not exist at l = 0. If l0 = 0, all functions have a limit there and return
// it. If l0 > 0, the energy has the tip of a cone there. The force is then zero (the mean over all
// directions), and the stiffness is the longitudinal one in every direction. So both stay finite
// and K stays symmetric.

// The spring's length l [m].
template <class Real, int D>
Real spring_length(const Eigen::Matrix<Real, D, 1>& d) {
  using std::sqrt;
  return sqrt((d.transpose() * d).value());  // no conjugation: analytic in d
}

// The spring's energy V [J].
template <class Law, class Real, int D>
Real spring_energy(const Law& law, const Eigen::Matrix<Real, D, 1>& d) {
  return law.energy(spring_length(d));
}

// The force on x_i [N], tau n = -dV/dx_i; the force on x_j is its opposite.
template <class Law, class Real, int D>
[[gnu::always_inline]] inline Eigen::Matrix<Real, D, 1> spring_force(
    const Law& law, const Eigen::Matrix<Real, D, 1>& d) {
  if constexpr (D == 1 && std::is_same_v<Real, double>) {  // n is a sign: nothing to divide by
    const double tension = law.tension(std::abs(d[0]));
    return Eigen::Matrix<Real, D, 1>(d[0] > 0 ? tension : d[0] < 0 ? -tension : 0);
  }
  const Real l = spring_length(d);
  return d * (std::abs(l) > 0 ? law.tension(l) / l : Real(0));
}

// The discrete gradient of a spring that goes from d0 to d1, as a force on x_i [N]: the secant
// (V1 - V0)/(l1 - l0) of its energy times (d0 + d1)/(l0 + l1). Its product with d1 - d0 is exactly
// V1 - V0, for (d0 + d1).(d1 - d0) = (l0 + l1)(l1 - l0). Zero if both lengths are zero.
template <class Law, int D>
Eigen::Matrix<double, D, 1> spring_discrete_gradient(const Law& law,
                                                     const Eigen::Matrix<double, D, 1>& d0,
                                                     const Eigen::Matrix<double, D, 1>& d1) {
  const double l0 = d0.norm(), l1 = d1.norm();
  return (d0 + d1) * (l0 + l1 > 0 ? law.secant(l0, l1) / (l0 + l1) : 0);
}

// The D x D block B = tau' nn' + (tau/l)(I - nn') [N/m]: K_ij = K_ji = B, K_ii and K_jj lose B. B
// is indefinite if the spring is compressed (tau < 0), which makes structures buckle; then
// `compression` scales tau/l, and likewise a tau' < 0.
template <class Law, class Real, int D>
Eigen::Matrix<Real, D, D> spring_stiffness(const Law& law, const Eigen::Matrix<Real, D, 1>& d,
                                           double compression = 1) {
  using Block = Eigen::Matrix<Real, D, D>;
  const Real l = spring_length(d);
  if (std::abs(l) == 0) return Block::Identity() * law.tangent(l);
  Real along = law.tangent(l);
  if constexpr (std::is_same_v<Law, SpringLaw>) {  // a cubic term may soften the spring
    if (std::real(along) < 0) along *= compression;
  }
  if constexpr (D == 1) return Block(along);
  Real across = law.tension(l) / l;
  if (std::real(across) < 0) across *= compression;
  const Eigen::Matrix<Real, D, 1> n = d / l;
  return Block::Identity() * across + (along - across) * (n * n.transpose());
}

// The material part tau' nn' of this block [N/m], without the tension; all of B if l0 = 0, as such
// a spring is always in tension; zero if tau' < 0. Positive semidefinite.
template <class Law, class Real, int D>
Eigen::Matrix<Real, D, D> spring_material_stiffness(const Law& law,
                                                    const Eigen::Matrix<Real, D, 1>& d) {
  const Real l = spring_length(d);
  if (law.rest_length == 0 || std::abs(l) == 0) return spring_stiffness(law, d);
  const Eigen::Matrix<Real, D, 1> n = d / l;
  Real along = law.tangent(l);
  if (std::real(along) < 0) along = 0;
  return along * (n * n.transpose());
}

// The force of a spring's dashpot on x_i [N], where the ends move apart by w = x_j' - x_i' [m/s]:
// c l' n with l' = n.w, the derivative of Rayleigh's 1/2 c l'^2. A spring of rest length zero may
// pass through length zero, where it has no direction. So its dashpot resists w in all directions
// alike, c w. Any other dashpot does so only at length zero.
template <class Law, class Real, int D>
Eigen::Matrix<Real, D, 1> dashpot_force(const Law& law, const Eigen::Matrix<Real, D, 1>& d,
                                        const Eigen::Matrix<Real, D, 1>& w) {
  const Real square = (d.transpose() * d).value();
  if constexpr (std::is_same_v<Law, SpringLaw>) {
    using std::sqrt;
    if (law.is_slack(std::real(sqrt(square)))) return 0.0 * w;
  }
  if (D == 1 || law.rest_length == 0 || std::abs(square) == 0) return law.damping * w;
  return d * (law.damping * (d.transpose() * w).value() / square);
}

}  // namespace qddot
