#include <filesystem>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

#include <boost/test/unit_test.hpp>
#include <fmt/format.h>

#include "qddot/scene/generators.hpp"
#include "tests/folder.hpp"
#include "tests/scene/scene_texts.hpp"

BOOST_AUTO_TEST_SUITE(scene_file)

namespace fs = std::filesystem;
using namespace qddot;

BOOST_AUTO_TEST_CASE(numbers_are_read_exactly) {
  const Scene scene = parsed(two_links);
  BOOST_TEST(scene.name == "two links");
  BOOST_TEST(scene.dimension == 2);
  BOOST_TEST((scene.gravity == Eigen::Vector3d(0, -9.81, 0)));
  BOOST_TEST(scene.until.value() == 0.5);
  BOOST_TEST_REQUIRE(scene.nodes.size() == 2);
  BOOST_TEST((scene.nodes[0].position == Eigen::Vector3d(0.1, 0, 0)));
  BOOST_TEST(scene.nodes[0].pinned);
  BOOST_TEST((scene.nodes[1].position == Eigen::Vector3d(3.1, 4, 0)));
  BOOST_TEST((scene.nodes[1].velocity == Eigen::Vector3d(0, -1e-3, 0)));
  BOOST_TEST(scene.nodes[1].mass == 2);
  BOOST_TEST(!scene.nodes[1].pinned);
  BOOST_TEST_REQUIRE(scene.springs.size() == 1);
  BOOST_TEST(scene.springs[0].nodes[1] == 1);
  BOOST_TEST(scene.springs[0].law.stiffness == 1000);
  BOOST_TEST(scene.springs[0].law.rest_length == 0.5);
  BOOST_TEST(scene.springs[0].law.quartic == 7);
}

BOOST_AUTO_TEST_CASE(defaults) {
  const Scene scene = parsed(
      "dimension = 2\n"
      "nodes = [{position = [0, 0], pinned = true},"
      " {position = [3, 4], mass = 1}]\n"
      "springs = [{nodes = [1, 0], stiffness = 1}]\n");
  BOOST_TEST(scene.name == "a");  // as the file
  BOOST_TEST(!scene.until);
  BOOST_TEST((scene.gravity == Eigen::Vector3d::Zero()));
  BOOST_TEST((scene.nodes[1].velocity == Eigen::Vector3d::Zero()));
  BOOST_TEST(scene.springs[0].law.rest_length == 5);
  BOOST_TEST(scene.springs[0].law.quartic == 0);
  BOOST_TEST(!scene.starts_at_equilibrium);
}

BOOST_AUTO_TEST_CASE(unusual_scenes_are_valid) {
  const std::vector<std::string> texts = {
      // no spring
      "dimension = 1\n[[nodes]]\nposition = [0]\nmass = 1\n",
      "dimension = 1\nsprings = []\n[[nodes]]\nposition = [0]\nmass = 1\n",
      // all nodes pinned
      "dimension = 1\n[[nodes]]\nposition = [0]\npinned = true\n[[nodes]]\nposition = [1]\n"
      "pinned = true\n[[springs]]\nnodes = [0, 1]\nstiffness = 1\n",
      // a massless node between springs
      "dimension = 1\n[[nodes]]\nposition = [0]\npinned = true\n[[nodes]]\nposition = [1]\n"
      "mass = 0\n[[nodes]]\nposition = [2]\nmass = 1\n[[springs]]\nnodes = [0, 1]\n"
      "stiffness = 1\n[[springs]]\nnodes = [1, 2]\nstiffness = 1\n",
      // coincident ends of a spring without length, and two springs side by side
      "dimension = 1\n[[nodes]]\nposition = [0]\npinned = true\n[[nodes]]\nposition = [0]\n"
      "mass = 1\n[[springs]]\nnodes = [0, 1]\nstiffness = 1\n[[springs]]\nnodes = [0, 1]\n"
      "stiffness = 0\nrest_length = 0\n"};
  for (const std::string& text : texts) BOOST_TEST(refusal(text) == "");
}

BOOST_AUTO_TEST_CASE(every_kind_of_scene_may_start_at_equilibrium) {
  const std::string generated = "[generator]\nkind = 'orbit'\n";
  for (const std::string& text : {two_links, mesh_scene, generated}) {
    BOOST_TEST(!parsed(text).starts_at_equilibrium);
    BOOST_TEST(!parsed("start = 'drawn'\n" + text).starts_at_equilibrium);
    BOOST_TEST(parsed("start = 'equilibrium'\n" + text).starts_at_equilibrium);
    for (const std::string value : {"'rest'", "''", "'Equilibrium'", "true", "1", "['drawn']"})
      BOOST_TEST(names_all(refusal("start = " + value + "\n" + text), {"a.toml:1: start: "}),
                 value);
  }
  BOOST_TEST(names_all(refusal("start = 'rest'\n" + two_links),
                       {"rest", "allowed", "\"drawn\" and \"equilibrium\""}));
}

BOOST_AUTO_TEST_CASE(every_kind_of_scene_may_name_its_stiff_springs) {
  const std::string generated = "[generator]\nkind = 'orbit'\n";
  for (const std::string& text : {two_links, mesh_scene, generated}) {
    BOOST_TEST(!parsed(text).stiff_above);
    BOOST_TEST(parsed("stiff_above = 2.5\n" + text).stiff_above.value() == 2.5);
    BOOST_TEST(parsed("stiff_above = 3\n" + text).stiff_above.value() == 3);
    for (const std::string value :
         {"0", "-1", "-0.0", "nan", "inf", "-inf", "'3'", "true", "[3]", "{k = 3}", "2020-01-01"}) {
      const std::string message = refusal("stiff_above = " + value + "\n" + text);
      BOOST_TEST(names_all(message, {"a.toml:1: stiff_above: ", "allowed", "above 0"}), message);
    }
  }
  // A generator may name its own; the file's word is the last.
  const std::string framed = "[generator]\nkind = 'framed_cloth'\nnodes = 3\n";
  BOOST_TEST(parsed(framed).stiff_above.value() > 1000);
  BOOST_TEST(parsed("stiff_above = 7\n" + framed).stiff_above.value() == 7);
  BOOST_TEST(names_all(refusal(framed + "stiff_above = 7\n"), {"stiff_above", "not a parameter"}));
}

BOOST_AUTO_TEST_CASE(a_file_is_read_as_its_text) {
  const Folder folder;
  const Scene read = read_scene(folder.write("bare.toml", with(two_links, "name", "#")));
  BOOST_TEST(read.name == "bare");
  BOOST_TEST(content_hash(read) == content_hash(parsed(two_links)));
}

BOOST_AUTO_TEST_CASE(only_regular_files_are_opened) {
  const Folder folder;
  const std::string pipe = folder / "pipe.toml";
  BOOST_TEST_REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  for (const std::string& path : {pipe, std::string("/dev/zero")}) {
    const std::string refusal = refusal_of([&] { load_scene(path); });
    BOOST_TEST(names_all(refusal, {path, "pipe", "regular files"}), refusal);
  }
}

BOOST_AUTO_TEST_CASE(unreadable_paths_are_named) {
  const Folder folder;
  const auto said_of = [](const std::string& path) {
    return refusal_of([&] { read_scene(path); });
  };
  BOOST_TEST(names_all(said_of(folder / "none.toml"), {"none.toml", "No such file", "allowed"}));
  BOOST_TEST(names_all(said_of(folder / "."), {"folder", "allowed"}));
  const std::string secret = folder.write("secret.toml", two_links);
  fs::permissions(secret, fs::perms::none);
  if (geteuid() != 0)  // nothing is unreadable to root
    BOOST_TEST(names_all(said_of(secret), {"secret.toml", "Permission denied", "allowed"}));
}

BOOST_AUTO_TEST_CASE(a_mesh_becomes_nodes_springs_and_pins) {
  const Folder folder;
  fs::create_directory(folder / "sub");
  folder.write("sub/m.obj", tetrahedron);
  const std::string text = with(mesh_scene, "m.obj", "sub/m.obj");
  const Scene scene = read_scene(folder.write("a.toml", "gravity = [0, 0, -1]\n" + text));
  BOOST_TEST_REQUIRE(scene.nodes.size() == 4);
  BOOST_TEST_REQUIRE(scene.springs.size() == 6);
  BOOST_TEST(scene.dimension == 3);
  BOOST_TEST((scene.gravity == Eigen::Vector3d(0, 0, -1)));
  BOOST_TEST((scene.nodes[1].position == Eigen::Vector3d(2, 0, 0)));
  BOOST_TEST(scene.nodes[1].mass == 2);
  BOOST_TEST(!scene.nodes[0].pinned);
  BOOST_TEST(scene.nodes[3].pinned);
  BOOST_TEST(scene.springs[0].law.rest_length == 2);
  BOOST_TEST(scene.springs[0].law.stiffness == 10);

  // Each edge of a closed surface is shared by two triangles.
  const Scene stiff =
      parsed(with(mesh_scene, "stiffness = 10", "stiffness = 10\nbending_stiffness = 3"));
  BOOST_TEST_REQUIRE(stiff.springs.size() == 12);
  BOOST_TEST(stiff.springs[11].law.stiffness == 3);
}

BOOST_AUTO_TEST_CASE(unused_vertices_of_a_mesh_are_left_out_and_counted) {
  // Before, between and after those of the tetrahedron.
  const std::string stray =
      "v 7 7 7\nv 0 0 0\nv 1 0 0\nv 8 8 8\nv 0 1 0\nv 0 0 1\nv 9 9 9\n"
      "f 2 3 5\nf 2 3 6\nf 3 5 6\nf 2 5 6\n";
  const auto read = [&](const std::string& mesh) {
    return parse_scene(with(mesh_scene, "stiffness = 10", "stiffness = 10\nbending_stiffness = 3"),
                       "a.toml", "", {}, [&](const std::string&) { return mesh; });
  };
  const Scene clean = read(tetrahedron), scene = read(stray);
  BOOST_TEST(scene.nodes.size() == 4);
  BOOST_TEST(content_hash(scene) == content_hash(clean));  // total_mass is that of the used ones
  BOOST_TEST(clean.warnings.empty());
  BOOST_TEST_REQUIRE(scene.warnings.size() == 1);
  BOOST_TEST(names_all(scene.warnings[0], {"m.obj", "3 vertices", "no edge", "left out"}));
  BOOST_TEST(
      names_all(read(tetrahedron + "v 5 5 5\n").warnings.at(0), {"1 vertex", "is left out"}));
  BOOST_TEST(names_all(refusal_of([&] { read("v 0 0 0\nv 1 0 0\n"); }),
                       {"mesh.file", "no edge", "allowed"}));
}

BOOST_AUTO_TEST_CASE(nodes_whose_motion_nothing_decides_are_named) {
  const std::string massless = with(two_links, "mass = 2", "mass = 0");
  BOOST_TEST(parsed(massless).warnings.empty());  // its spring decides
  const std::string loose = with(with(massless, "1000.0", "0"), "quartic = 7.0", "quartic = 0");
  BOOST_TEST_REQUIRE(parsed(loose).warnings.size() == 1);
  BOOST_TEST(names_all(parsed(loose).warnings[0], {"node 1 ", "neither a mass nor a spring"}));
  BOOST_TEST(parsed(with(loose, "mass = 0\n", "mass = 1\n")).warnings.empty());
  std::string many = "dimension = 1\n";
  for (int i = 0; i < 12; ++i) many += fmt::format("[[nodes]]\nposition = [{}]\nmass = 0\n", i);
  BOOST_TEST(
      names_all(parsed(many).warnings.at(0), {"nodes 0, 1, 2,", "7, ... have", "they keep"}));
}

BOOST_AUTO_TEST_CASE(generators_and_files_are_named_alike) {
  const Folder folder;
  const Generator& generator = generators().front();
  const Scene drawn = load_scene(generator.name);
  const Scene read = load_scene(folder.write(
      "g.toml", "name = 'n'\nuntil = 3\n[generator]\nkind = '" + generator.name + "'"));
  BOOST_TEST(read.name == "n");
  BOOST_TEST(read.until.value() == 3);
  BOOST_TEST(content_hash(read) == content_hash(drawn));
  BOOST_TEST(load_scene(folder.write("a.toml", two_links)).nodes.size() == 2);
  BOOST_CHECK_EXCEPTION(load_scene("no such scene"), InvalidInput, [&](const InvalidInput& error) {
    return names_all(error.what(), {"no such scene", "neither", "allowed", generator.name});
  });
}

BOOST_AUTO_TEST_CASE(the_hash_sees_all_that_moves) {
  const auto hash = [&](const std::string& text) { return content_hash(parsed(text)); };
  const std::string base = hash(two_links);
  BOOST_TEST(base.size() == 16);
  BOOST_TEST(hash(with(two_links, "two links", "other")) == base);
  BOOST_TEST(hash(with(two_links, "0.1, 0.0", "0.1, -0.0")) == base);
  BOOST_TEST(hash(with(two_links, "mass = 0.1", "mass = 9")) == base);  // pinned
  BOOST_TEST(hash("stiff_above = 500\n" + two_links) == base);          // moves nothing
  for (const auto& [old_part, new_part] :
       std::vector<std::pair<std::string, std::string>>{{"-9.81", "-9.80"},
                                                        {"0.1, 0.0", "0.1, 1e-300"},
                                                        {"3.1, 4", "3.1, 4.5"},
                                                        {"-1e-3", "1e-3"},
                                                        {"mass = 2", "mass = 3"},
                                                        {"pinned = true", "pinned = false"},
                                                        {"[0, 1]", "[1, 0]"},
                                                        {"1000.0", "1000.1"},
                                                        {"rest_length = 0.5", "rest_length = 0.25"},
                                                        {"quartic = 7.0", "quartic = 0"}})
    BOOST_TEST(hash(with(two_links, old_part, new_part)) != base, new_part);
}

BOOST_AUTO_TEST_SUITE_END()
