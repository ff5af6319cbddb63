#include <cfloat>
#include <cmath>
#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/scene/same_scene.hpp"
#include "tests/scene/scene_texts.hpp"

BOOST_AUTO_TEST_SUITE(scene_writer)

using namespace qddot;

namespace {

Scene read_back(const Scene& scene) { return parsed(to_toml(scene)); }

const std::vector<double> hard_numbers = {0,       -0.0,
                                          1,       -1,
                                          0.1,     0x1.5555555555555p-2,
                                          5e-324,  123,
                                          -1e308,  1e308,
                                          1e15,    1e16,
                                          1e-310,  1e22,
                                          1e23,    0x1.0000000000001p0,
                                          100,     4.1e-5,
                                          -1e-300, 9007199254740992.0,
                                          DBL_MAX};

// Numbers of every size and sign, the hard ones among them.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}

  double any() {
    const auto hard = random_() % (2 * hard_numbers.size());
    if (hard < hard_numbers.size()) return hard_numbers[hard];
    const double x = std::ldexp(1 + 1e-9 * static_cast<double>(random_()),
                                static_cast<int>(random_() % 2000) - 1060);
    return random_() % 2 ? x : -x;
  }
  // -0 is not negative.
  double not_negative() {
    const double x = any();
    return x < 0 ? -x : x;
  }
  std::size_t below(std::size_t n) { return random_() % n; }

 private:
  std::mt19937 random_;
};

Scene random_scene(unsigned seed) {
  Numbers numbers(seed);
  Scene scene;
  scene.name = "random";
  scene.dimension = 1 + static_cast<int>(numbers.below(3));
  scene.starts_at_equilibrium = numbers.below(2) == 0;
  if (numbers.below(2)) scene.until = std::abs(numbers.any()) + 1e-300;
  if (numbers.below(2)) scene.stiff_above = std::abs(numbers.any()) + 1e-300;
  const auto vector = [&] {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int k = 0; k < scene.dimension; ++k) x[k] = numbers.any();
    return x;
  };
  scene.gravity = vector();
  for (std::size_t i = 0; i < 2 + numbers.below(6); ++i)
    scene.nodes.push_back({vector(), vector(), numbers.not_negative(), numbers.below(2) == 0});
  for (Node& node : scene.nodes) {
    if (node.mass > 0 && numbers.below(3) == 0) node.load = vector();
  }
  for (std::size_t i = 0; i < numbers.below(8); ++i) {
    const std::size_t a = numbers.below(scene.nodes.size());
    const std::size_t b = (a + 1) % scene.nodes.size();
    const bool apart = (scene.nodes[a].position - scene.nodes[b].position).norm() > 0;
    scene.springs.push_back({{a, b},
                             {.stiffness = numbers.not_negative(),
                              .rest_length = apart ? numbers.not_negative() : 0,
                              .quartic = numbers.not_negative()}});
  }
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_generator_is_read_back_to_the_bit) {
  for (const Generator& generator : generators()) {
    const Scene scene = generate(generator, {}, "test");
    BOOST_TEST(first_difference(scene, read_back(scene)) == "", generator.name);
  }
}

BOOST_AUTO_TEST_CASE(random_scenes_are_read_back_to_the_bit) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    const Scene scene = random_scene(seed);
    validate(scene, "random scene");
    const std::string difference = first_difference(scene, read_back(scene));
    BOOST_TEST(difference == "", seed << ": " << to_toml(scene));
  }
}

BOOST_AUTO_TEST_CASE(any_name_is_read_back) {
  Scene scene{.dimension = 1, .nodes = {{.mass = 1}}};
  std::string controls;
  for (char c = 0; c < ' '; ++c) controls += c;
  std::string many_dots;
  for (int i = 0; i < 200; ++i) many_dots += "a.";
  for (const std::string& name :
       {many_dots, std::string(), std::string("two links"), std::string("\"quoted\" 'too'"),
        std::string("\\ and \\u0041 and \\\""), controls + "\x7f", std::string("a\r\nb\n\n"),
        std::string("Brücke 桥 🌉 \u0085\u2028\ufeff\uffff"), std::string("\U0010ffff\ud7ff\ue000"),
        std::string("v1.2.3"), std::string("# = [[nodes]]"), std::string(100'000, '"')}) {
    scene.name = name;
    const std::string text = to_toml(scene);
    BOOST_TEST(first_difference(scene, parsed(text)) == "", text.substr(0, 200));
  }
  scene.name = "v1.2";
  BOOST_TEST(to_toml(scene).starts_with("name = \"v1.2\"\n"));
}

BOOST_AUTO_TEST_CASE(bytes_that_are_no_text_are_replaced_in_a_name) {
  Scene scene{.dimension = 1, .nodes = {{.mass = 1}}};
  for (const std::string bad : {"\xff", "\x80", "\xc3", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80",
                                "\xf0\x80\x80\x80", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80"}) {
    scene.name = "a" + bad + "é";
    const std::string name = read_back(scene).name;
    BOOST_TEST(name.starts_with("a\ufffd"));
    BOOST_TEST(name.ends_with("\ufffdé"));
  }
}

BOOST_AUTO_TEST_CASE(a_text_too_large_to_be_read_is_refused) {
  const Scene scene = parsed(two_links), nodes{.name = "n", .nodes = {scene.nodes[1]}};
  for (const Scene& one : {scene, nodes}) {
    const std::size_t size = to_toml(one).size();
    BOOST_TEST(refusal_of([&] { to_toml(one, size); }) == "");
    BOOST_TEST(names_all(refusal_of([&] { to_toml(one, size - 1); }),
                         {"scene " + one.name + ": ", "MB", "allowed"}));
  }
}

BOOST_AUTO_TEST_CASE(a_written_scene_is_one_to_edit) {
  const Scene scene = parsed(two_links);
  BOOST_TEST(to_toml(scene) ==
             "name = \"two links\"\n"
             "dimension = 2\n"
             "gravity = [0.0, -9.81]\n"
             "until = 0.5\n"
             "start = \"drawn\"\n"
             "\n[[nodes]]\n"
             "position = [0.1, 0.0]\n"
             "mass = 0.1\n"
             "pinned = true\n"
             "\n[[nodes]]\n"
             "position = [3.1, 4.0]\n"
             "velocity = [0.0, -0.001]\n"
             "mass = 2.0\n"
             "\n[[springs]]\n"
             "nodes = [0, 1]\n"
             "stiffness = 1000.0\n"
             "rest_length = 0.5\n"
             "quartic = 7.0\n");
}

BOOST_AUTO_TEST_SUITE_END()
