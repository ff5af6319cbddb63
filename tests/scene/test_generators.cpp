#include <map>
#include <set>

#include <boost/test/unit_test.hpp>

#include "tests/measure.hpp"
#include "tests/scene/drawn.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(generators)

using namespace qddot;

namespace {

// The sentence by which generate() refuses the values; empty if it accepts them.
std::string refusal(const Generator& generator, const GeneratorValues& values) {
  return refusal_of([&] { generate(generator, values, "option --scene"); });
}

double total_mass(const Scene& scene) {
  double sum = 0;
  for (const Node& node : scene.nodes) sum += node.mass;
  return sum;
}

std::size_t pinned_count(const Scene& scene) {
  return static_cast<std::size_t>(std::ranges::count_if(scene.nodes, &Node::pinned));
}

double length(const Scene& scene, const Spring& spring) {
  return (scene.nodes[spring.nodes[1]].position - scene.nodes[spring.nodes[0]].position).norm();
}

// The largest part by which a spring's rest length differs from the distance of its ends.
double largest_strain(const Scene& scene) {
  double largest = 0;
  for (const Spring& spring : scene.springs) {
    const double l = length(scene, spring);
    largest = std::max(largest, std::abs(l - spring.law.rest_length) / l);
  }
  return largest;
}
// Positions up to 30 spacings from the origin cost their difference 5 bits.
constexpr double no_strain = 64 * eps;

// No spring twice, in either direction.
bool all_distinct(const Scene& scene) {
  std::set<std::set<std::size_t>> pairs;
  for (const Spring& spring : scene.springs) pairs.insert({spring.nodes[0], spring.nodes[1]});
  return pairs.size() == scene.springs.size();
}

// The number of springs of each length, in tenths of `unit`, and stiffness.
std::map<std::pair<long, double>, int> census(const Scene& scene, double unit) {
  std::map<std::pair<long, double>, int> count;
  for (const Spring& spring : scene.springs)
    ++count[{std::lround(10 * length(scene, spring) / unit), spring.law.stiffness}];
  return count;
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_generator_draws_a_valid_scene_of_its_name) {
  std::set<std::string> names;
  for (const Generator& generator : qddot::generators()) {
    const Scene scene = generate(generator, {}, "test");
    validate(scene, "test");
    BOOST_TEST(scene.name == generator.name);
    BOOST_TEST(!generator.summary.empty());
    BOOST_TEST(scene.until.has_value());
    BOOST_TEST(find_generator(generator.name) == &generator);
    names.insert(generator.name);
  }
  BOOST_TEST(names.size() == qddot::generators().size());
  BOOST_TEST(find_generator("clot") == nullptr);
}

BOOST_AUTO_TEST_CASE(every_parameter_is_taken_at_the_ends_of_its_range_and_refused_beyond) {
  for (const Generator& generator : qddot::generators()) {
    for (const GeneratorParameter& parameter : generator.parameters) {
      const auto refused = [&](double value) {
        const std::string message = refusal(generator, {{parameter.name, value}});
        return message.starts_with("option --scene") && names_all(message, {parameter.name});
      };
      BOOST_TEST_CONTEXT(generator.name << " " << parameter.name) {
        BOOST_TEST(parameter.low <= parameter.standard);
        BOOST_TEST(parameter.standard <= parameter.high);
        BOOST_TEST(refusal(generator, {{parameter.name, parameter.low}}) == "");
        // The most nodes would fill the memory.
        if (!parameter.whole)
          BOOST_TEST(refusal(generator, {{parameter.name, parameter.high}}) == "");
        BOOST_TEST(refused(std::nextafter(parameter.low, -INFINITY)));
        BOOST_TEST(refused(std::nextafter(parameter.high, INFINITY)));
        BOOST_TEST(refused(NAN));
        BOOST_TEST(refused(INFINITY));
        if (parameter.whole) BOOST_TEST(refused(parameter.low + 0.5));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(unknown_parameter_is_refused_with_those_that_exist) {
  for (const Generator& generator : qddot::generators()) {
    const std::string message = refusal(generator, {{"colour", 1}});
    BOOST_TEST(message.starts_with("option --scene"));
    BOOST_TEST(names_all(message, {"colour", generator.name}));
    for (const GeneratorParameter& parameter : generator.parameters)
      BOOST_TEST(names_all(message, {parameter.name}));
  }
}

BOOST_AUTO_TEST_CASE(cloth_is_the_documented_one) {
  const Scene scene = draw("cloth");
  BOOST_TEST(scene.dimension == 3);
  BOOST_TEST(scene.nodes.size() == 900u);
  BOOST_TEST(std::abs(total_mass(scene) - 0.5) < 900 * eps);  // as many roundings
  BOOST_TEST((scene.gravity == Eigen::Vector3d(0, 0, -9.81)));
  BOOST_TEST(*scene.until == 0.1);
  // Structural 2 N (N - 1), shear 2 (N - 1)^2, bending 2 N (N - 2): 5102 together.
  const std::map<std::pair<long, double>, int> expected = {
      {{10, 1000}, 1740}, {{14, 500}, 1682}, {{20, 100}, 1680}};
  BOOST_TEST((census(scene, 1.0 / 29) == expected));
  BOOST_TEST(scene.springs.size() == 5102u);
  BOOST_TEST(all_distinct(scene));
  BOOST_TEST(largest_strain(scene) < no_strain);
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Vector3d> pins;
  for (const Node& node : scene.nodes) {
    box.extend(node.position);
    BOOST_TEST(node.velocity.norm() == 0);
    if (node.pinned) pins.push_back(node.position);
  }
  BOOST_TEST((box.sizes() - Eigen::Vector3d(1, 1, 0)).norm() < 4 * eps);
  // Two corners of one side.
  BOOST_TEST(pins.size() == 2u);
  BOOST_TEST(std::abs((pins[1] - pins[0]).norm() - 1) < 4 * eps);
}

BOOST_AUTO_TEST_CASE(smallest_cloth_has_four_sides_and_two_diagonals) {
  const Scene scene = draw("cloth", {{"nodes", 2}, {"side", 3}});
  BOOST_TEST(scene.nodes.size() == 4u);
  const std::map<std::pair<long, double>, int> expected = {{{10, 1000}, 4}, {{14, 500}, 2}};
  BOOST_TEST((census(scene, 3) == expected));
}

BOOST_AUTO_TEST_CASE(framed_cloth_is_the_cloth_with_stiff_borders) {
  for (const double n : {2., 3., 30.}) {
    const Scene cloth = draw("cloth", {{"nodes", n}}),
                framed = draw("framed_cloth", {{"nodes", n}});
    BOOST_TEST((framed.gravity == cloth.gravity));
    BOOST_TEST(*framed.until == *cloth.until);
    BOOST_TEST_REQUIRE(framed.nodes.size() == cloth.nodes.size());
    for (std::size_t i = 0; i < cloth.nodes.size(); ++i) {
      BOOST_TEST((framed.nodes[i].position == cloth.nodes[i].position));
      BOOST_TEST(framed.nodes[i].mass == cloth.nodes[i].mass);
      BOOST_TEST(framed.nodes[i].pinned == cloth.nodes[i].pinned);
    }
    const auto on_border = [&](const Spring& spring) {
      const Eigen::Vector3d a = cloth.nodes[spring.nodes[0]].position,
                            b = cloth.nodes[spring.nodes[1]].position;
      const double last = cloth.nodes.back().position.x();
      const auto shared = [&](int d) { return a[d] == b[d] && (a[d] == 0 || a[d] == last); };
      return (shared(0) || shared(1)) && (b - a).norm() < 1.5 / (n - 1);
    };
    int stiff = 0;
    BOOST_TEST_REQUIRE(framed.springs.size() == cloth.springs.size());
    for (std::size_t e = 0; e < cloth.springs.size(); ++e) {
      const Spring &a = cloth.springs[e], &b = framed.springs[e];
      BOOST_TEST((a.nodes == b.nodes));
      BOOST_TEST(a.law.rest_length == b.law.rest_length);
      BOOST_TEST(b.law.stiffness == (on_border(a) ? 1e7 : a.law.stiffness));
      BOOST_TEST(is_stiff(b.law, framed.stiff_above) == on_border(a));
      stiff += on_border(a);
    }
    BOOST_TEST(stiff == 4 * (n - 1));
  }
}

BOOST_AUTO_TEST_CASE(a_frame_no_stiffer_than_its_cloth_is_not_stiff) {
  for (const double frame : {1e-12, 999., 1000., std::nextafter(1000, 2000), 1001., 1e12}) {
    const Scene scene = draw("framed_cloth", {{"nodes", 4}, {"frame_stiffness", frame}});
    const auto stiff = std::ranges::count_if(scene.springs, [&](const Spring& spring) {
      return is_stiff(spring.law, scene.stiff_above);
    });
    BOOST_TEST(stiff == (frame > 1000 ? 12 : 0), frame);
  }
}

BOOST_AUTO_TEST_CASE(lattice_joins_each_node_to_its_26_neighbours_and_pins_one_face) {
  const Scene scene = draw("lattice");
  BOOST_TEST(scene.nodes.size() == 1536u);
  BOOST_TEST(std::abs(total_mass(scene) - 1) < 1536 * eps);
  BOOST_TEST((scene.gravity == Eigen::Vector3d(0, 0, -9.81)));
  const double spacing = 1.0 / 23;
  // Along the edges, two diagonals a face, four a cell.
  const int edges = 23 * 8 * 8 + 2 * 24 * 7 * 8, faces = 2 * (24 * 7 * 7 + 2 * 23 * 7 * 8),
            cells = 4 * 23 * 7 * 7;
  const std::map<std::pair<long, double>, int> expected = {
      {{10, 5e4}, edges}, {{14, 5e4}, faces}, {{17, 5e4}, cells}};
  BOOST_TEST((census(scene, spacing) == expected));
  BOOST_TEST(all_distinct(scene));
  BOOST_TEST(largest_strain(scene) < no_strain);
  BOOST_TEST(pinned_count(scene) == 64u);
  for (const Node& node : scene.nodes) BOOST_TEST(node.pinned == (node.position.x() == 0));
  const auto far = std::ranges::max(scene.nodes, {}, [](const Node& n) { return n.position.x(); });
  BOOST_TEST(std::abs(far.position.x() - 1) < 4 * eps);
}

BOOST_AUTO_TEST_CASE(chain_hangs_on_the_ends_asked_for) {
  for (const double ends : {0.0, 1.0, 2.0}) {
    const Scene scene =
        draw("chain",
             {{"nodes", 12}, {"length", 3}, {"mass", 6}, {"pinned_ends", ends}, {"stiffness", 7}});
    BOOST_TEST(scene.nodes.size() == 12u);
    BOOST_TEST(std::abs(total_mass(scene) - 6) < 12 * 6 * eps);
    const std::map<std::pair<long, double>, int> expected = {{{10, 7}, 11}};
    BOOST_TEST((census(scene, 3.0 / 11) == expected));
    BOOST_TEST(all_distinct(scene));
    BOOST_TEST(largest_strain(scene) < no_strain);
    BOOST_TEST(scene.nodes.front().pinned == (ends >= 1));
    BOOST_TEST(scene.nodes.back().pinned == (ends == 2));
    BOOST_TEST(pinned_count(scene) == static_cast<std::size_t>(ends));
  }
}

BOOST_AUTO_TEST_CASE(single_masses_start_as_their_parameters_say) {
  const Scene line = draw("oscillator", {{"mass", 3}, {"position", -2}, {"velocity", 4}});
  BOOST_TEST(line.dimension == 1);
  BOOST_TEST(line.nodes[0].pinned);
  BOOST_TEST((line.nodes[1].position == Eigen::Vector3d(-2, 0, 0)));
  BOOST_TEST((line.nodes[1].velocity == Eigen::Vector3d(4, 0, 0)));
  BOOST_TEST(line.nodes[1].mass == 3);
  BOOST_TEST(line.springs.at(0).law.rest_length == 0);

  const Scene orbit = draw("orbit", {{"radius", 2}, {"speed", 5}});
  BOOST_TEST(orbit.gravity.norm() == 0);
  BOOST_TEST(length(orbit, orbit.springs.at(0)) == 2);
  BOOST_TEST(std::abs(orbit.nodes[1].velocity.norm() - 5) < 4 * 5 * eps);
  BOOST_TEST(orbit.nodes[1].velocity.dot(orbit.nodes[1].position) == 0);

  const Scene pendulum = draw("pendulum", {{"length", 2}, {"angle", 0.5}, {"speed", 3}});
  const Eigen::Vector3d arm = pendulum.nodes[1].position;
  BOOST_TEST(std::abs(arm.norm() - 2) < 4 * 2 * eps);
  // The angle between arm and gravity.
  BOOST_TEST(std::abs(arm.dot(pendulum.gravity) / 2 / 9.81 - std::cos(0.5)) < 8 * eps);
  BOOST_TEST(pendulum.nodes[1].velocity.dot(arm) == 0);
  BOOST_TEST(pendulum.nodes[1].velocity.norm() == 3);
}

BOOST_AUTO_TEST_CASE(pair_turns_about_its_resting_centre_of_mass) {
  for (const double rest_length : {0.0, 2.0}) {
    const Scene scene = draw("pair", {{"rest_length", rest_length}, {"stretch", 1.5}, {"spin", 3}});
    const Node &a = scene.nodes[0], &b = scene.nodes[1];
    BOOST_TEST((a.mass * a.position + b.mass * b.position).norm() < 10 * eps);
    BOOST_TEST((a.mass * a.velocity + b.mass * b.velocity).norm() < 10 * eps);
    const double expected = rest_length > 0 ? 3.0 : 1.5;
    BOOST_TEST(std::abs(length(scene, scene.springs.at(0)) - expected) < 10 * eps);
    BOOST_TEST(std::abs((b.velocity - a.velocity).norm() - 3 * expected) < 50 * eps);
    BOOST_TEST(pinned_count(scene) == 0u);
  }
}

BOOST_AUTO_TEST_SUITE_END()
