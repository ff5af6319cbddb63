#include "qddot/integrators/registry.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <sundials/sundials_config.h>

#include "qddot/integrators/integrator.hpp"

// One line a method; each is defined in the file of its name or of its family. Those of newer
// versions of SUNDIALS come last, the newest at the end: lists are the same with any version.
#define QDDOT_METHODS(METHOD)      \
  METHOD(explicit_euler)           \
  METHOD(symplectic_euler)         \
  METHOD(semi_implicit_euler)      \
  METHOD(implicit_euler)           \
  METHOD(implicit_midpoint)        \
  METHOD(trapezoidal)              \
  METHOD(generalized_alpha)        \
  METHOD(hht)                      \
  METHOD(bdf2)                     \
  METHOD(trbdf2)                   \
  METHOD(discrete_gradient)        \
  METHOD(rodas4)                   \
  METHOD(local_global)             \
  METHOD(local_global_chebyshev)   \
  METHOD(local_global_anderson)    \
  METHOD(local_global_lbfgs)       \
  METHOD(verlet)                   \
  METHOD(position_verlet)          \
  METHOD(rk4)                      \
  METHOD(rk8)                      \
  METHOD(rkc)                      \
  METHOD(blanes_moan4)             \
  METHOD(blanes_moan6)             \
  METHOD(kahan_li8)                \
  METHOD(takahashi_imada4)         \
  METHOD(symmetric4)               \
  METHOD(symmetric6)               \
  METHOD(symmetric8)               \
  METHOD(symmetric10)              \
  METHOD(dprkn6)                   \
  METHOD(dprkn8)                   \
  METHOD(dprkn12)                  \
  METHOD(linear_midpoint)          \
  METHOD(linear_midpoint4)         \
  METHOD(multirate_adams2)         \
  METHOD(multirate_adams4)         \
  METHOD(multirate_adams5)         \
  METHOD(exact)                    \
  METHOD(rattle)                   \
  METHOD(rattle4)                  \
  METHOD(rattle6)                  \
  METHOD(rattle8)                  \
  METHOD(arkode_dirk2)             \
  METHOD(arkode_dirk3)             \
  METHOD(arkode_dirk4)             \
  METHOD(arkode_dirk5)             \
  METHOD(arkode_dirk2_klu)         \
  METHOD(arkode_dirk3_klu)         \
  METHOD(arkode_dirk4_klu)         \
  METHOD(arkode_dirk5_klu)         \
  METHOD(arkode_erk2)              \
  METHOD(arkode_erk3)              \
  METHOD(arkode_erk4)              \
  METHOD(arkode_erk5)              \
  METHOD(arkode_erk6)              \
  METHOD(arkode_erk8)              \
  METHOD(arkode_imex3)             \
  METHOD(arkode_imex4)             \
  METHOD(arkode_imex5)             \
  METHOD(arkode_mri3)              \
  METHOD(arkode_mri4)              \
  METHOD(arkode_implicit_euler)    \
  METHOD(arkode_implicit_midpoint) \
  METHOD(arkode_sdirk2)            \
  METHOD(arkode_trbdf2)            \
  METHOD(ida)                      \
  METHOD(ida_klu)                  \
  METHOD(ida_rods)                 \
  METHOD(arkode_erk8_rods)         \
  METHOD(cvode_bdf)                \
  METHOD(cvode_bdf_klu)            \
  METHOD(cvode_adams)              \
  METHOD(arkode_sprk2)             \
  METHOD(arkode_sprk3)             \
  METHOD(arkode_sprk4)             \
  METHOD(arkode_sprk5)             \
  METHOD(arkode_sprk6)             \
  METHOD(arkode_sprk8)             \
  METHOD(arkode_sprk10)            \
  METHOD(arkode_relaxed4)          \
  METHOD(arkode_relaxed5)          \
  METHOD(arkode_relaxed6)          \
  METHOD(arkode_ssp3)              \
  METHOD(arkode_ssp4)

namespace qddot {

namespace registered {
#define QDDOT_DECLARE(method) Method method();
QDDOT_METHODS(QDDOT_DECLARE)
}  // namespace registered

namespace {

std::vector<Method> methods_that(bool can_run) {
#define QDDOT_CALL(method) registered::method(),
  std::vector<Method> all = {QDDOT_METHODS(QDDOT_CALL)};
  std::erase_if(all, [&](const Method& method) { return (method.make != nullptr) != can_run; });
  return all;
}

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> all = methods_that(true);
  return all;
}

const std::vector<Method>& newer_methods() {
  static const std::vector<Method> all = methods_that(false);
  return all;
}

std::string sundials_needed(const Method& method) {
  const int version = method.needs_sundials;
  return version == 0 ? "" : fmt::format("{}.{}", version / 10000, version / 100 % 100);
}

std::string why_not_built(std::string_view name) {
  const auto found = std::ranges::find(newer_methods(), name, &Method::name);
  if (found == newer_methods().end()) return {};
  return fmt::format("{} needs SUNDIALS {} or newer; this is built with {}", name,
                     sundials_needed(*found), SUNDIALS_VERSION);
}

const Method* find_method(std::string_view name) {
  const auto found = std::ranges::find(methods(), name, &Method::name);
  return found == methods().end() ? nullptr : &*found;
}

std::unique_ptr<Integrator> make_integrator(const Method& method, const System& system,
                                            const Options& options) {
  check_options(method, options);
  return std::make_unique<Integrator>(method, system, options);
}

}  // namespace qddot
