#include "qddot/measure/stability/linear_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot::inline measure {
namespace {

using Complex = std::complex<double>;

// The relative error that rounding may leave in the responses of an oscillator.
constexpr double root_rounding = 1e-11;
constexpr double start_rounding = 64 * machine_epsilon;

// The roots of a 2 x 2 matrix. Near a double root, t +- sqrt(s) keeps digits that an iteration
// loses, and s by the entries off the diagonal keeps more than t^2 - d.
std::vector<Complex> pair_of_roots(const Eigen::Matrix2d& a) {
  const double t = (a(0, 0) + a(1, 1)) / 2, half = (a(0, 0) - a(1, 1)) / 2;
  const double discriminant = half * half + a(0, 1) * a(1, 0);
  if (discriminant < 0) {
    const double imaginary = std::sqrt(-discriminant);
    return {{t, imaginary}, {t, -imaginary}};
  }
  const double larger = t + std::copysign(std::sqrt(discriminant), t);
  return {larger, larger == 0 ? 0 : a.determinant() / larger};
}

// Each start has its own response. A step leaves rounding of what it began with, and some of the
// start's own unit.
bool is_close(const Eigen::Matrix2d& y, const Eigen::Matrix2d& expected,
              const Eigen::Matrix2d& before, double noise) {
  const auto size = y.colwise().norm().cwiseMax(before.colwise().norm());
  return ((y - expected).colwise().norm().array() <= noise * size.array() + start_rounding).all();
}

// The matrix of a step without memory.
Eigen::Matrix2d step_without_memory(const Responses& y) { return y[1] * y[0].inverse(); }

bool is_without_memory(const Responses& y, double noise) {
  const Eigen::Matrix2d step = step_without_memory(y);
  Eigen::Matrix2d expected = y[1];
  for (std::size_t n = 2; n < y.size(); ++n) {
    expected = step * expected;
    if (!is_close(y[n], expected, y[n - 1], noise)) return false;
  }
  return true;
}

// The roots of the A that has a row for each singular value above the noise.
std::vector<Complex> realized_roots(const Responses& y, double noise) {
  constexpr int blocks = (steps_observed + 1) / 2, size = 2 * blocks;
  using Hankel = Eigen::Matrix<double, size, size>;
  Hankel now, next;
  for (int i = 0; i < blocks; ++i) {
    for (int j = 0; j < blocks; ++j) {
      const auto n = static_cast<std::size_t>(i + j);
      now.block<2, 2>(2 * i, 2 * j) = y[n];
      next.block<2, 2>(2 * i, 2 * j) = y[n + 1];
    }
  }
  const Eigen::JacobiSVD<Hankel, Eigen::NoQRPreconditioner> svd(
      now, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const auto& values = svd.singularValues();
  const auto rank = std::max<Index>(1, (values.array() > noise * values[0]).count());
  const Vec inverse = values.head(rank).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd a =
      inverse.asDiagonal() *
      (svd.matrixU().leftCols(rank).transpose() * (next * svd.matrixV().leftCols(rank))) *
      inverse.asDiagonal();
  const Eigen::VectorXcd roots = general_values(a);
  return {roots.begin(), roots.end()};
}

// The largest power of two up to `size`: a unit that changes no digit.
double unit(double size) { return std::exp2(std::floor(std::log2(size))); }

std::vector<Complex> found_roots(Responses y, double noise) {
  if (y.size() > 1 && is_without_memory(y, noise)) return pair_of_roots(step_without_memory(y));
  if (y.size() <= steps_observed) return {std::numeric_limits<double>::infinity()};
  // The responses to all steps shall count, also if the vibration dies or grows at once.
  const double change = std::pow(y.back().norm() / y.front().norm(), 1.0 / steps_observed);
  const double factor = std::isnormal(change) ? unit(change) : 1;
  for (std::size_t n = 0; n < y.size(); ++n) y[n] *= std::pow(factor, -static_cast<double>(n));
  std::vector<Complex> roots = realized_roots(y, noise);
  for (Complex& root : roots) root *= factor;
  return roots;
}

// One mass and one spring of rest length zero with w = 1, on a line, beside a dashpot. `quartic`
// [N/m^3] of its law.
std::unique_ptr<System> oscillator(double quartic, double zeta) {
  Network network{.dimension = 1, .node_mass = Vec::Ones(1)};
  network.anchors = {
      {0, Eigen::Vector3d::Zero(), {.stiffness = 1, .quartic = quartic, .damping = 2 * zeta}}};
  return make_mass_spring(network);
}

// In one correction, Newton's method leaves the rounding of its prediction, up to (h w)^2 times the
// solution. It takes more if the law is not linear by its form. This quartic part is none.
constexpr double nominal_quartic = 1e-307, finest_solve = 1e-16;

Responses respond(const Method& method, Options options, double zeta) {
  const bool refines = method.listens_to(Option::solve_tolerance) && options.solve_tolerance == 0;
  if (refines) options.solve_tolerance = finest_solve;
  const auto system = oscillator(refines ? nominal_quartic : 0, zeta);
  const auto integrator = make_integrator(method, *system, options);
  Responses y(steps_observed + 1, Eigen::Matrix2d::Identity());
  for (const int start : {0, 1}) {
    State state{0, Vec::Constant(1, 1 - start), Vec::Constant(1, start)};
    Observer each;
    for (int n = 1; n <= steps_observed; ++n) each.times.push_back(n * options.step_size);
    std::size_t n = 0;
    each.see = [&](const State& seen) { y[++n].col(start) << seen.q[0], seen.v[0]; };
    const Summary summary = integrator->advance(state, each.times.back(), each);
    if (summary.outcome == Outcome::diverged) {
      y.resize(std::min(y.size(), n + 1));
    } else if (summary.outcome != Outcome::reached_end) {
      throw std::runtime_error(fmt::format("{} on an oscillator at h w = {:g}: {}", method.name,
                                           options.step_size, summary.message));
    }
  }
  return y;
}

// The responses in units of a step, in which stiff methods have no large numbers. A velocity is a
// displacement h v. A start at q has h^2 a = -(h w)^2 q, and that at v has h v.
Responses in_units_of_a_step(Responses y, double h) {
  const double stiff = unit(std::max(1.0, h));
  const Eigen::Vector2d of_state(1, stiff), of_start(1 / (stiff * stiff), 1 / stiff);
  for (Eigen::Matrix2d& each : y) each = of_state.asDiagonal() * each * of_start.asDiagonal();
  return y;
}

}  // namespace

Complex LinearStep::principal() const {
  if (zeta == 0 || spectral_radius() > 1) return roots.front();
  const Complex slower = -zeta + std::sqrt(Complex(zeta * zeta - 1));
  const Complex exact = std::exp(h_omega * slower);
  return *std::ranges::min_element(roots, {},
                                   [&](const Complex& root) { return std::abs(root - exact); });
}

double LinearStep::damping_ratio() const {
  const Complex exponent = std::log(principal());  // of the modulus, and i times the angle
  return exponent == 0. ? 0 : -exponent.real() / std::abs(exponent);
}

double LinearStep::period_error() const {
  const double angle = std::abs(std::arg(principal()));
  return angle == 0 ? std::numeric_limits<double>::infinity() : h_omega / angle - 1;
}

std::vector<Complex> roots_of(const Responses& y, double noise) {
  std::vector<Complex> roots = found_roots(y, noise);
  std::ranges::stable_sort(roots, std::ranges::greater(),
                           [](const Complex& root) { return std::abs(root); });
  return roots;
}

LinearStep linear_step(const Method& method, double h_omega, Options options, double zeta) {
  if (!has_linear_step(method)) {
    throw std::invalid_argument(method.name + " has no step of its own: it chooses its steps");
  }
  if (zeta > 0 && method.takes_damping() != Damped::by_any)
    throw std::invalid_argument(method.name + " takes no dashpots");
  if (method.recurrence_roots) return {h_omega, method.recurrence_roots(h_omega, zeta), zeta};
  options.step_size = h_omega;  // w = 1
  return {h_omega,
          roots_of(in_units_of_a_step(respond(method, options, zeta), h_omega), root_rounding),
          zeta};
}

}  // namespace qddot::inline measure
