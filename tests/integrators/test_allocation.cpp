#include <atomic>
#include <cstdlib>

#include <boost/test/unit_test.hpp>

#include "tests/integrators/runs.hpp"

// Every allocation of this program, Eigen's and operator new's among them, is one of malloc.
namespace {
std::atomic<std::int64_t> allocations = 0;
}  // namespace
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

using namespace qddot;

BOOST_AUTO_TEST_SUITE(allocation)

namespace {

// Of a run of a made integrator.
std::int64_t allocations_of(const Method& method, const Knobs& knobs, double t_end) {
  const Problem p = hammock(3);
  const auto system = make_mass_spring(p.network);
  const auto integrator = make_integrator(method, *system, knobs);
  State state = p.initial;
  const std::int64_t before = allocations;
  const Summary summary = integrator->advance(state, t_end);
  const std::int64_t after = allocations;
  BOOST_REQUIRE(summary.message == "");
  BOOST_REQUIRE(summary.counts.steps > 20 * t_end);
  return after - before;
}

}  // namespace

BOOST_AUTO_TEST_CASE(explicit_steps_allocate_nothing) {
  for (const Method& method : methods_of(Family::hand_written)) {
    if (method.implicit) continue;
    BOOST_TEST_CONTEXT(method.name) {
      const Knobs knobs = knobs_of(method, 0.005, 1e-8);
      BOOST_TEST(allocations_of(method, knobs, 4) == allocations_of(method, knobs, 0.5));
    }
  }
}

BOOST_AUTO_TEST_CASE(an_allocation_is_noticed) {
  const std::int64_t before = allocations;
  const Vec vector = Vec::Zero(7);
  const auto number = std::make_unique<double>(vector[3]);
  BOOST_TEST(allocations - before == 2);
}

BOOST_AUTO_TEST_SUITE_END()
