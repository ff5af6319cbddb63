#include <boost/test/unit_test.hpp>

#include "qddot/scene/generators.hpp"
#include "qddot/scene/scene_file.hpp"
#include "qddot/scene/settle.hpp"
#include "tests/folder.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(faces)

using namespace qddot;

namespace {

using Faces = std::vector<std::array<std::size_t, 3>>;

Scene small(const char* generator) {
  return generate(*find_generator(generator), {{"nodes", 3}}, "test");
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_cloth_has_two_faces_a_cell) {
  for (const char* generator : {"cloth", "framed_cloth"}) {
    const Scene scene = small(generator);
    BOOST_REQUIRE(scene.faces.size() == 8);
    double area = 0;  // of the square with sides of 1 m
    for (const auto& [a, b, c] : scene.faces) {
      const Eigen::Vector3d& x = scene.nodes[a].position;
      const Eigen::Vector3d n =
          (scene.nodes[b].position - x).cross(scene.nodes[c].position - x) / 2;
      BOOST_TEST(n[2] > 0);  // all face the same way
      area += n[2];
    }
    // Sums of eight areas with roundings of 1e-16 each.
    BOOST_TEST(std::abs(area - 1) < 1e-14);
  }
  BOOST_TEST(small("chain").faces.empty());
}

BOOST_AUTO_TEST_CASE(nodes_of_a_face_are_numbered_without_vertices_left_out) {
  const Folder folder;
  folder.write("a.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 8 8 8\nv 1 1 0\nv 0 1 0\nf 2 3 5 6\n");
  folder.write("a.toml",
               "[mesh]\nfile = \"a.obj\"\nstiffness = 10.0\nnode_mass = 1.0\nscale = 2.0\n");
  const Scene scene = read_scene(folder / "a.toml");
  BOOST_TEST((scene.faces == Faces{{0, 1, 2}, {0, 2, 3}}));
  BOOST_TEST((scene.nodes[scene.faces[0][2]].position == Eigen::Vector3d(2, 2, 0)));
}

BOOST_AUTO_TEST_CASE(faces_decide_no_motion_and_are_there_at_equilibrium) {
  Scene scene = small("cloth");
  BOOST_TEST((settled(scene, "test").faces == scene.faces));
  const std::string hash = content_hash(scene);
  const std::string text = to_toml(scene);
  scene.faces.clear();
  BOOST_TEST(content_hash(scene) == hash);
  BOOST_TEST(to_toml(scene) == text);
}

BOOST_AUTO_TEST_CASE(faces_of_other_nodes_are_refused) {
  Scene scene = small("cloth");
  const auto refused = [&](const std::array<std::size_t, 3>& face) {
    scene.faces = {{0, 1, 2}, face};
    return refusal_of([&] { validate(scene, "test"); });
  };
  BOOST_TEST(refused({3, 4, 8}) == "");
  BOOST_TEST(refused({0, 1, 9}) ==
             "test: faces[1].nodes: [0, 1, 9] is not allowed; allowed are three different nodes "
             "from 0 to 8");
  for (const std::array<std::size_t, 3>& face :
       {std::array<std::size_t, 3>{1, 1, 2}, {1, 2, 2}, {2, 1, 2}})
    BOOST_TEST(refused(face).find("three different nodes") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
