#include <boost/test/unit_test.hpp>

#include "qddot/scene/scene_file.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(simulate_write_scene)

using namespace qddot;

namespace {

using Words = std::vector<std::string>;

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_scene_is_written_without_a_run) {
  const Folder folder;
  for (const char* scene : {"cloth", "orbit"}) {
    const Exit result = run("simulate", {"--scene", scene, "--write-scene", folder / "s.toml"});
    BOOST_TEST(result.status == 0);
    BOOST_TEST(result.err == "");
    BOOST_TEST(result.out == "");
    BOOST_TEST(folder.listing() == "s.toml ");
    BOOST_TEST(read_all(folder / "s.toml").ends_with(to_toml(load_scene(scene))));
  }
}

BOOST_AUTO_TEST_CASE(a_written_scene_moves_as_the_one_it_is_of) {
  const Folder folder;
  const Words options = {"--method", "verlet", "--step-size", "5e-4", "--until", "0.01"};
  const Exit first =
      run("simulate", with(options, {"--scene", "cloth", "--write-scene", folder / "s.toml",
                                     "--final", folder / "a.csv"}));
  BOOST_TEST(first.status == 0);
  BOOST_TEST(folder.listing() == "a.csv a.json s.toml ");
  const Exit second =
      run("simulate", with(options, {"--scene", folder / "s.toml", "--final", folder / "b.csv"}));
  BOOST_TEST(second.status == 0);
  BOOST_TEST((read_all(folder / "a.csv") == read_all(folder / "b.csv")));
  BOOST_TEST(untimed(first) == untimed(second));
}

BOOST_AUTO_TEST_CASE(inputs_are_never_replaced_and_files_of_others_by_force_alone) {
  const Folder folder;
  const std::string scene = folder / "s.toml", mesh = folder / "m.obj";
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  folder.write("s.toml", "[mesh]\nfile = 'm.obj'\nstiffness = 1\nnode_mass = 1\n");
  const std::string text = read_all(scene);
  const Words options = {"--scene",     scene,  "--method", "verlet",
                         "--step-size", "0.01", "--until",  "0.1"};
  for (const std::string& place : {scene, mesh}) {
    for (const char* option : {"--final", "--write-scene"}) {
      for (const Words& more : {Words{}, Words{"--force"}}) {
        const Exit result = run("simulate", with(with(options, {option, place}), more));
        BOOST_TEST(complains(result, 2, "simulate", {place, "was read"}), result.err);
      }
    }
  }
  BOOST_TEST(read_all(scene) == text);
  folder.write("end.json", "mine");
  const Words end = with(options, {"--final", folder / "end.csv"});
  BOOST_TEST(complains(run("simulate", end), 2, "simulate", {"end.json", "--force"}));
  BOOST_TEST(read_all(folder / "end.json") == "mine");
  BOOST_TEST(folder.listing() == "end.json m.obj s.toml ");
  BOOST_TEST(run("simulate", with(end, {"--force"})).status == 0);
  BOOST_TEST(run("simulate", end).status == 0);  // its own by now
}

BOOST_AUTO_TEST_SUITE_END()
