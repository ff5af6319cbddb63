#include <cmath>
#include <fstream>
#include <sys/stat.h>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "experiments/kit/reference_file.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/folder.hpp"
#include "tests/fragments.hpp"

BOOST_AUTO_TEST_SUITE(reference_file)

using namespace qddot;

namespace {

constexpr double until = 0.1;

// The reference of a scene that the folder keeps or gets.
Reference kept(const std::string& name, double horizon, const Folder& folder) {
  const Scene drawn = load_scene(name);
  return reference_for(drawn, drawn, Model(drawn), horizon, folder.path(),
                       {{"command_line", "test"}, {"compiler", "test"}, {"made", "here"}});
}

// The reference as a file brings it back, which has to say the same when it is written again.
Reference read_back(const Reference& made) {
  const nlohmann::json written = to_json(made);
  const Reference read = reference_from_json(nlohmann::json::parse(written.dump()));
  BOOST_TEST(to_json(read).dump() == written.dump());
  return read;
}

}  // namespace

BOOST_AUTO_TEST_CASE(json_brings_back_every_bit) {
  const Reference made = make_reference(Model(load_scene("pair")), 0.3, 1);
  const Reference read = read_back(made);
  BOOST_TEST((read.end.q == made.end.q && read.end.v == made.end.v));
  BOOST_TEST(made.perturbation_growth > 0);
  BOOST_TEST((std::isinf(made.horizon) && std::isinf(read.horizon)));
  const nlohmann::json written = to_json(made);
  for (const char* part : {"position", "velocity", "energy"}) {
    const double certified = written.at(fmt::format("certified_{}", part));
    const double digits = written.at("certified_digits").at(part);
    BOOST_TEST(std::abs(digits + std::log10(certified)) <= 0.1 + 1e-9);
    BOOST_TEST(digits <= -std::log10(certified));
  }
}

BOOST_AUTO_TEST_CASE(json_brings_back_what_is_known_of_chaos_symmetry_and_parts) {
  Reference made;
  made.end = {2, Vec::Ones(2), Vec::Ones(2)};
  made.certified = {0.1, 0.1, 1e-9};
  made.perturbation_growth = 1e14;
  made.horizon = 1.3;
  made.lyapunov = 27.1;
  made.modal_shares = Vec{{0.1, 0.3, 0.6}};
  made.modal_shares_floor = 1e-3;
  nlohmann::json written = to_json(made);
  BOOST_TEST((written.at("beyond_horizon") == true && written.at("chaotic") == true));
  const Reference chaotic = read_back(made);
  BOOST_TEST((chaotic.horizon == made.horizon && chaotic.lyapunov == made.lyapunov));
  BOOST_TEST((chaotic.modal_shares == made.modal_shares));
  BOOST_TEST(chaotic.modal_shares_floor == made.modal_shares_floor);
  made.horizon = std::numeric_limits<double>::infinity();
  made.certified = {1e-9, 1e-9, 1e-9};
  made.scales = {.displacement = 3, .speed = 4, .kinetic = 5};
  made.scales.parts = {{.nodes = {1, 2}, .extent = 7, .displacement = 3, .speed = 4},
                       {.nodes = {4}, .extent = 8, .displacement = 1e-10, .speed = 1e-9}};
  made.is_reduced_by_symmetry = true;
  made.out_of_symmetry = OutOfSymmetry{.effect = 0.3, .horizon = 1.5, .lyapunov = 66};
  written = to_json(made);
  BOOST_TEST(written.at("only_symmetric") == true);
  BOOST_TEST(contains(written.at("scales").at("of").get<std::string>(), {"divided by", "[m/s]"}));
  const Reference read = read_back(made);
  BOOST_TEST((read.is_reduced_by_symmetry && read.is_only_symmetric()));
  BOOST_TEST_REQUIRE(read.scales.parts.size() == 2u);
  BOOST_TEST((read.scales.parts[0].nodes == made.scales.parts[0].nodes));
  made.out_of_symmetry->horizon = std::numeric_limits<double>::infinity();
  const Reference never = read_back(made);
  BOOST_TEST((std::isinf(never.out_of_symmetry->horizon) && !never.is_only_symmetric()));
}

BOOST_AUTO_TEST_CASE(json_that_is_no_reference_is_refused) {
  Reference made;
  made.end = {1, Vec::Ones(2), Vec::Ones(2)};
  made.certified = {1e-9, 1e-9, 1e-9};
  const nlohmann::json good = to_json(made);
  BOOST_CHECK_NO_THROW(reference_from_json(good));
  for (const char* key :
       {"t", "q", "v", "energy", "scales", "certified_position", "certified_velocity",
        "certified_energy", "rounding_effect", "perturbation_growth", "made_by", "seconds"}) {
    nlohmann::json without = good, spoiled = good;
    without.erase(key);
    spoiled[key] = nullptr;
    BOOST_CHECK_THROW(reference_from_json(without), nlohmann::json::exception);
    BOOST_CHECK_THROW(reference_from_json(spoiled), nlohmann::json::exception);
  }
}

BOOST_AUTO_TEST_CASE(what_the_file_keeps_is_what_was_made) {
  const Folder folder;
  const Reference made = kept("orbit", until, folder);
  BOOST_TEST(folder.listing() == "reference.json ");
  const auto json = nlohmann::json::parse(read_all(folder / "reference.json"));
  BOOST_TEST(json.at("made") == "here");
  BOOST_TEST(json.at("scene") == "orbit");
  BOOST_TEST(json.at("until") == until);
  const Reference again = kept("orbit", until, folder);
  BOOST_TEST(again.seconds == made.seconds);  // no other making takes as long to the last bit
  BOOST_TEST((again.end.q == made.end.q && again.end.v == made.end.v));
}

// Its energy at the end is less than at the start by what damping took.
BOOST_AUTO_TEST_CASE(the_reference_of_a_damped_scene_is_kept_too) {
  const Folder folder;
  const std::string scene = folder / "damped.toml";
  std::ofstream(scene) << "damping_time = 1e-3\n[generator]\nkind = \"chain\"\nnodes = 4\n";
  const Reference made = kept(scene.c_str(), until, folder);
  BOOST_TEST(made.end.work.dissipated > 0);
  const Reference again = kept(scene.c_str(), until, folder);
  BOOST_TEST(again.seconds == made.seconds);
  BOOST_TEST(again.end.work.dissipated == made.end.work.dissipated);
}

BOOST_AUTO_TEST_CASE(a_file_that_is_not_as_it_was_written_is_not_believed) {
  const Folder folder;
  const Reference made = kept("oscillator", until, folder);
  const std::string file = folder / "reference.json", whole = read_all(file);
  const auto spoiled = [&](const char* what, double value) {
    nlohmann::json json = nlohmann::json::parse(whole);
    (std::string(what) == "q" ? json["q"][0] : json[what]) = value;
    return json;
  };
  for (nlohmann::json json : {spoiled("q", made.end.q[0] + 0.01), spoiled("certified_position", 1),
                              spoiled("energy", 2), spoiled("t", until / 2)}) {
    std::ofstream(file) << json;
    const Reference again = kept("oscillator", until, folder);
    BOOST_TEST(again.end.q[0] == made.end.q[0]);
    BOOST_TEST(again.certified.position == made.certified.position);
    BOOST_TEST(again.energy == made.energy);
  }
  // Cut short, or without a checksum.
  for (const std::string& text : {std::string(), whole.substr(0, whole.size() / 2), [&] {
                                    nlohmann::json json = nlohmann::json::parse(whole);
                                    json.erase("checksum");
                                    return json.dump();
                                  }()}) {
    std::ofstream(file) << text;
    BOOST_TEST(kept("oscillator", until, folder).end.q[0] == made.end.q[0]);
    BOOST_TEST(nlohmann::json::parse(read_all(file)).contains("checksum"));
  }
}

BOOST_AUTO_TEST_CASE(a_pipe_in_the_place_of_the_file_is_refused) {
  const Folder folder;
  BOOST_TEST_REQUIRE(mkfifo((folder / "reference.json").c_str(), 0600) == 0);
  BOOST_CHECK_THROW(kept("oscillator", until, folder), InvalidInput);
}

BOOST_AUTO_TEST_CASE(negative_control_another_motion_has_another_file) {
  const Folder folder;
  const Reference orbit = kept("orbit", until, folder);
  const Reference pair = kept("pair", until, folder);
  // Two nodes and one in their plane.
  BOOST_TEST(pair.end.q.size() == 4);
  BOOST_TEST(orbit.end.q.size() == 2);
  const auto json = nlohmann::json::parse(read_all(folder / "reference.json"));
  BOOST_TEST(json.at("scene") == "pair");
  BOOST_TEST(kept("pair", 2 * until, folder).end.t == 2 * until);
}

BOOST_AUTO_TEST_CASE(a_massless_node_has_no_reference) {
  Scene scene{.name = "massless", .dimension = 1};
  scene.nodes = {{.pinned = true}, {.position = {1, 0, 0}}};
  scene.springs = {{{0, 1}, {.stiffness = 1}}};
  BOOST_CHECK_THROW(require_reference_exists(Model(scene), "here"), InvalidInput);
  scene.nodes[1].mass = 1;
  BOOST_CHECK_NO_THROW(require_reference_exists(Model(scene), "here"));
}

BOOST_AUTO_TEST_SUITE_END()
