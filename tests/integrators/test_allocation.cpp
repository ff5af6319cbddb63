#include <atomic>
#include <cstdlib>

#include <boost/test/unit_test.hpp>

#include "integrators/fixed_step.hpp"
#include "tests/integrators/runs.hpp"

// Every allocation of this program, Eigen's and operator new's among them, is one of malloc.
namespace {
std::atomic<std::int64_t> allocations = 0;
}  // namespace
#ifdef __SANITIZE_ADDRESS__
extern "C" void __sanitizer_malloc_hook(const volatile void*, std::size_t) { ++allocations; }
extern "C" void __sanitizer_free_hook(const volatile void*) {}
#else
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++allocations;
  return __libc_memalign(alignment, size);
}
#endif

using namespace qddot;

BOOST_AUTO_TEST_SUITE(allocation)

namespace {

struct Cost {
  std::int64_t allocations, bounds;  // of w_max
};

// Of a run of a made integrator.
Cost cost_of(const Method& method, const Knobs& knobs, double t_end) {
  const Problem p = hammock(3);
  const auto system = make_mass_spring(p.network);
  const auto integrator = make_integrator(method, *system, knobs);
  State state = p.initial;
  const std::int64_t before = allocations;
  const Summary summary = integrator->advance(state, t_end);
  const std::int64_t after = allocations;
  BOOST_REQUIRE(summary.message == "");
  BOOST_REQUIRE(static_cast<double>(summary.counts.steps) > 10 * t_end);
  return {after - before, summary.counts.stiffness_evaluations};
}

// Evaluates into memory of its own at each step.
class Spender final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  Outcome step(const State& now, double h, State& next) override {
    Vec f(system().size());
    force(now.q, f);
    next.v = now.v + h * f.cwiseQuotient(system().mass());
    next.q = now.q + h * next.v;
    return Outcome::reached_end;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(steps_allocate_nothing_but_for_a_bound_of_w_max_in_adaptive_explicit_ones) {
  for (const Method& method : methods_of(Family::hand_written)) {
    BOOST_TEST_CONTEXT(method.name) {
      const Knobs knobs = knobs_of(method, 0.005, 1e-10);
      const Cost many = cost_of(method, knobs, 8), few = cost_of(method, knobs, 1);
      // Every 50 steps a matrix of the sizes of K, which is three arrays, and a few vectors.
      const bool needs_bounds = method.knob == Knob::rtol && !method.implicit;
      BOOST_TEST(many.allocations - few.allocations <=
                 (needs_bounds ? 10 * (many.bounds - few.bounds) : 0));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_vector_a_step_is_noticed) {
  Method spender = method_named("symplectic_euler");
  spender.make = create<Spender>;
  const Knobs knobs{.step_size = 0.005};
  const std::int64_t more =
      cost_of(spender, knobs, 8).allocations - cost_of(spender, knobs, 1).allocations;
  BOOST_TEST(more >= 1400);
}

BOOST_AUTO_TEST_CASE(an_allocation_is_noticed) {
  const std::int64_t before = allocations;
  const Vec vector = Vec::Zero(7);
  const auto number = std::make_unique<double>(vector[3]);
  BOOST_TEST(allocations - before == 2);
}

BOOST_AUTO_TEST_SUITE_END()
