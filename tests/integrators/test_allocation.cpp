#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>

#include <boost/test/unit_test.hpp>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/scene/rods.hpp"
#include "tests/integrators/scenes.hpp"
#include "tests/scene/drawn.hpp"

// Counts the allocations of the program and of its libraries. Operator new, Eigen, CHOLMOD, KLU and
// SUNDIALS all call malloc and its siblings. These are defined here and call the C library's.
static std::atomic<std::int64_t> allocations = 0;

#ifdef __SANITIZE_ADDRESS__
extern "C" void __sanitizer_malloc_hook(const volatile void*, std::size_t) { ++allocations; }
extern "C" void __sanitizer_free_hook(const volatile void*) {}
#else
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  ++allocations;
  return __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++allocations;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  *memory = memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}
}
#endif

BOOST_AUTO_TEST_SUITE(allocation)

using namespace qddot;

namespace {

// A system on its way: how many steps the shorter run takes, with h w_max = hw in implicit methods,
// and the relative tolerance of adaptive ones.
struct Course {
  std::string name;
  std::shared_ptr<const System> system;
  State start;
  double hw = 0.3, rtol = 1e-5;
  int steps = 20;
};

Course course(std::string name, const Problem& problem) {
  return {std::move(name), make_mass_spring(problem.network), problem.initial};
}

Course course(std::string name, const Scene& scene) {
  const auto reduced = std::make_shared<Model>(scene);
  return {std::move(name), {reduced, &reduced->system()}, reduced->initial()};
}

// Springs at 0.7 of their rest length, which buckle, in steps so long that M - h^2 K is indefinite.
// Not every method gets over these.
Course strut_in_long_steps() {
  Course c = course("strut in long steps", draw("strut", {{"compression", 0.7}}));
  c.hw = 4;
  c.rtol = 1e-2;
  return c;
}

// Lets every unknown vibrate by up to `amplitude` [m], if with the highest frequency.
Course stirred(Course c, double amplitude) {
  const double w = frequency_bound(*c.system, c.start.q);
  for (Index i = 0; i < c.start.v.size(); ++i) {
    c.start.v[i] = amplitude * w * std::sin(static_cast<double>(i));
  }
  return c;
}

// More unknowns than what Eigen takes from the stack (16384 numbers), on springs of 0.1 mm.
Course long_chain() {
  Course c = course("long chain", draw("chain", {{"nodes", 9001}}));
  c.rtol = 1e-2;
  c.steps = 4;
  return stirred(std::move(c), 5e-6);
}

// Two bodies that nothing joins.
Course two_bodies() {
  std::mt19937 random(1);
  Scene scene{.dimension = 3};
  add_random_body(random, 5, {0, 0, 0}, scene);
  add_random_body(random, 6, {20, 0, 0}, scene);
  return course("two bodies", scene);
}

Course hem_of_rods() {
  Scene scene = draw("hemmed_cloth", {{"nodes", 5}});
  make_rods_above(1e6, scene);
  return course("hem of rods", scene);
}

std::vector<Course> courses() {
  return {course("hammock", hammock(3)),
          course("linear hammock", linear_hammock(3)),
          course("chain", draw("chain", {{"nodes", 8}})),
          course("cloth", draw("cloth", {{"nodes", 5}})),
          stirred(course("framed cloth", draw("framed_cloth", {{"nodes", 5}})), 0.01),
          two_bodies(),
          hem_of_rods(),
          course("strut", draw("strut", {{"compression", 0.7}})),
          strut_in_long_steps(),
          long_chain()};
}

struct Cost {
  std::int64_t allocations;
  Summary summary;
};

// Allocations of a run of a made integrator over `length` times its course's steps, of 3/w_max
// where they are not fixed, seen after each fourth.
Cost cost_of(const Method& method, const Course& c, int length, bool compensated) {
  const double w = frequency_bound(*c.system, c.start.q);
  const double hw = method.knob == Knob::rtol    ? 3
                    : method.is(Trait::implicit) ? c.hw
                                                 : 0.1,
               h = hw / w;
  Options options = options_of(method, h, c.rtol);
  options.compensated = compensated;
  const double t_end = length * c.steps * h;
  Observer observer{.times = {}, .see = [](const State&) {}};
  for (int i = 4; i < length * c.steps; i += 4) observer.times.push_back(i * h);
  const auto integrator = make_integrator(method, *c.system, options);
  State state = c.start;
  const std::int64_t before = allocations;
  Summary summary = integrator->advance(state, t_end, observer);
  return {allocations - before, std::move(summary)};
}

// The additional allocation of a run four times as long; empty if one of them does not reach its
// end.
std::optional<std::int64_t> more_of_longer_run(const Method& method, const Course& c,
                                               bool compensated = false) {
  const Cost few = cost_of(method, c, 1, compensated), many = cost_of(method, c, 4, compensated);
  if (!few.summary.message.empty() || !many.summary.message.empty()) return {};
  BOOST_TEST(many.summary.counts.steps >= few.summary.counts.steps + 3);
  return many.allocations - few.allocations;
}

}  // namespace

BOOST_AUTO_TEST_CASE(no_step_of_any_method_and_no_look_at_it_allocates) {
  // Some memory is allocated only once, as by OpenMP at the first factorisation.
  cost_of(method_named("semi_implicit_euler"), courses().front(), 1, false);
  for (const Course& c : courses()) {
    BOOST_TEST_CONTEXT(c.name) {
      int runs = 0, failed = 0;
      // Forces keep what they need of memory for the next.
      for (const char* method : {"explicit_euler", "discrete_gradient", "rattle"}) {
        cost_of(method_named(method), c, 1, false);
      }
      for (const Method& method : methods()) {
        if (!applies_to(method, *c.system)) continue;
        for (const bool compensated : {false, true}) {
          if (compensated && !method.listens_to(Option::compensated)) continue;
          BOOST_TEST_CONTEXT(method.name) {
            const auto more = more_of_longer_run(method, c, compensated);
            BOOST_TEST(more.value_or(0) == 0);
            ++runs;
            failed += !more;
          }
        }
      }
      BOOST_TEST(runs >= 4);
      BOOST_TEST(failed <= (c.hw > 1 ? runs / 3 : 0));
    }
  }
}

BOOST_DATA_TEST_CASE(every_method_is_seen_on_a_course, methods(), method) {
  const std::vector<Course> list = courses();
  BOOST_TEST(
      std::ranges::any_of(list, [&](const Course& c) { return applies_to(method, *c.system); }),
      method.name);
}

BOOST_AUTO_TEST_CASE(long_steps_of_the_strut_are_indefinite) {
  const Course c = strut_in_long_steps();
  for (const char* method : {"cvode_bdf", "ida"}) {
    const Counts counts = cost_of(method_named(method), c, 4, false).summary.counts;
    BOOST_TEST_CONTEXT(method << ": " << counts) {
      BOOST_TEST(counts.indefinite_factorizations > 0);
    }
  }
}

BOOST_AUTO_TEST_CASE(an_allocation_is_noticed) {
  const std::int64_t before = allocations;
  const Vec vector = Vec::Zero(7);
  const auto number = std::make_unique<double>(vector[3]);
  // Compilers may leave out what nobody sees.
  const auto show = [](const void* memory) { asm volatile("" : : "r"(memory) : "memory"); };
  show(number.get());
  BOOST_TEST(allocations - before == 2);
  void* block = std::calloc(3, 8);
  show(block);
  block = std::realloc(block, 1000);
  show(block);
  std::free(block);
  BOOST_TEST(allocations - before == 4);
}

BOOST_AUTO_TEST_SUITE_END()
