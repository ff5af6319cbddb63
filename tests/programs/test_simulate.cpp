#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(simulate)

using namespace qddot;

namespace {

// A triangle in D dimensions with its pinned node in the middle of the list; what that node is
// said to do is for nothing.
std::string triangle(int dimension) {
  const auto vector = [&](double x, double y, double z) {
    return dimension == 1   ? fmt::format("[{}]", x)
           : dimension == 2 ? fmt::format("[{}, {}]", x, y)
                            : fmt::format("[{}, {}, {}]", x, y, z);
  };
  return fmt::format(
      "dimension = {}\nuntil = 0.5\ngravity = {}\n"
      "nodes = [{{position = {}, mass = 1}}, {{position = {}, velocity = {}, pinned = true}},"
      " {{position = {}, velocity = {}, mass = 2}}]\n"
      "springs = [{{nodes = [0, 1], stiffness = 50}}, {{nodes = [1, 2], stiffness = 70}},"
      " {{nodes = [2, 0], stiffness = 90, quartic = 10}}]\n",
      dimension, vector(1, -9, 0.5), vector(0, 0, 0), vector(1.1, 0.2, 0.3), vector(5, 5, 5),
      vector(2.3, -0.4, 0.1), vector(-0.3, 0.7, 0.2));
}

// The expected output: the library's own run, seen at the given times.
struct Expected {
  ReducedScene scene;
  std::vector<State> states;

  Expected(const std::string& path, const char* method, const Options& options, double until,
           const std::vector<double>& times)
      : scene(load_scene(path)) {
    State state = scene.initial();
    states.push_back(state);
    make_integrator(*find_method(method), scene.system(), options)
        ->advance(state, until, {times, [&](const State& seen) { states.push_back(seen); }});
    states.push_back(state);
  }
};

// The columns from `first` on are the nodes of the state, to the bit.
void check_nodes(const Table& table, std::size_t first_row, std::size_t first_column,
                 const ReducedScene& scene, const State& state) {
  const auto nodes = scene.expand(state);
  BOOST_TEST_REQUIRE(table.rows.size() >= first_row + nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& row = table.rows[first_row + i];
    std::vector<std::string> fields = {std::to_string(i)};
    for (const Eigen::Vector3d& x : {nodes[i].position, nodes[i].velocity}) {
      for (int d = 0; d < scene.dimension(); ++d) fields.push_back(fmt::format("{:.17g}", x[d]));
    }
    const std::vector<std::string> written(row.begin() + std::ptrdiff_t(first_column), row.end());
    BOOST_TEST(written == fields, boost::test_tools::per_element());
  }
}

std::vector<std::string> with(std::vector<std::string> first,
                              const std::vector<std::string>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<std::string> verlet(const std::string& scene) {
  return {"--scene", scene, "--method", "verlet", "--step-size", "0.001", "--until", "0.5"};
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_final_table_holds_every_node_to_the_bit) {
  const std::array<const char*, 4> headers = {"", "node,x,vx", "node,x,y,vx,vy",
                                              "node,x,y,z,vx,vy,vz"};
  for (int dimension = 1; dimension <= 3; ++dimension) {
    const Folder folder;
    const std::string scene = folder.write("s.toml", triangle(dimension));
    BOOST_TEST(run("simulate", with(verlet(scene), {"--final", folder / "f.csv"})).status == 0);
    const Table table = read_csv(folder / "f.csv");
    BOOST_TEST(table.header == headers[static_cast<std::size_t>(dimension)]);
    BOOST_TEST(table.rows.size() == 3u);
    const Expected expected(scene, "verlet", {.step_size = 0.001}, 0.5, {});
    check_nodes(table, 0, 0, expected.scene, expected.states.back());
    BOOST_TEST(table.value(1, "x") == 1.1);
    BOOST_TEST(table.value(1, "vx") == 0);
    BOOST_TEST(folder.listing() == "f.csv f.json s.toml ");
  }
}

BOOST_AUTO_TEST_CASE(adaptive_methods_write_the_same) {
  const Folder folder;
  const std::string scene = folder.write("s.toml", triangle(2));
  BOOST_TEST(run("simulate", {"--scene", scene, "--method", "ida", "--rtol", "1e-6", "--atol",
                              "1e-8", "--final", folder / "f.csv"})
                 .status == 0);
  const Expected expected(scene, "ida", {.rtol = 1e-6, .atol = 1e-8}, 0.5, {});
  check_nodes(read_csv(folder / "f.csv"), 0, 0, expected.scene, expected.states.back());
}

BOOST_AUTO_TEST_CASE(the_trajectory_holds_all_nodes_at_each_sample) {
  const Folder folder;
  const std::string scene = folder.write("s.toml", triangle(3));
  BOOST_TEST(
      run("simulate", with(verlet(scene), {"--trajectory", folder / "g.csv", "--every", "0.125"}))
          .status == 0);
  const Table table = read_csv(folder / "g.csv");
  BOOST_TEST(table.header == "t,node,x,y,z,vx,vy,vz");
  BOOST_TEST_REQUIRE(table.rows.size() == 15u);
  const std::vector<double> times = {0.125, 0.25, 0.375, 0.5};
  const Expected expected(scene, "verlet", {.step_size = 0.001}, 0.5, times);
  for (std::size_t sample = 0; sample < 5; ++sample) {
    for (std::size_t node = 0; node < 3; ++node) {
      BOOST_TEST(table.value(3 * sample + node, "t") == 0.125 * static_cast<double>(sample));
    }
    check_nodes(table, 3 * sample, 1, expected.scene, expected.states[sample]);
  }
}

BOOST_AUTO_TEST_CASE(the_energy_is_kinetic_and_potential_and_their_sum) {
  const Folder folder;
  const std::string scene = folder.write("s.toml", triangle(2));
  BOOST_TEST(run("simulate", with(verlet(scene), {"--energy", folder / "e.csv", "--every", "0.25"}))
                 .status == 0);
  const Table table = read_csv(folder / "e.csv");
  BOOST_TEST(table.header == "t,kinetic,potential,total");
  BOOST_TEST_REQUIRE(table.rows.size() == 3u);
  const Expected expected(scene, "verlet", {.step_size = 0.001}, 0.5, {0.25, 0.5});
  for (std::size_t i = 0; i < 3; ++i) {
    const State& state = expected.states[i];
    BOOST_TEST(table.value(i, "t") == 0.25 * static_cast<double>(i));
    BOOST_TEST(table.value(i, "kinetic") == expected.scene.system().kinetic(state.v));
    BOOST_TEST(table.value(i, "potential") == expected.scene.system().potential(state.q));
    BOOST_TEST(table.value(i, "total") == table.value(i, "kinetic") + table.value(i, "potential"));
  }
}

BOOST_AUTO_TEST_CASE(each_output_has_the_every_behind_it_and_a_single_one_is_for_both) {
  const auto rows = [](const std::vector<std::string>& outputs) {
    const Folder folder;
    std::vector<std::string> arguments = verlet("oscillator");
    for (const std::string& word : outputs) {
      arguments.push_back(word.ends_with(".csv") ? folder / word : word);
    }
    const Exit result = run("simulate", arguments);
    BOOST_TEST(result.status == 0, exit_in_words(result, arguments));
    return std::array{std::ssize(read_csv(folder / "g.csv").rows) / 2,
                      std::ssize(read_csv(folder / "e.csv").rows)};
  };
  constexpr std::array<std::ptrdiff_t, 2> apart = {3, 6}, together = {6, 6};
  BOOST_TEST((rows({"--trajectory", "g.csv", "--every", "0.2", "--energy", "e.csv", "--every",
                    "0.1"}) == apart));
  BOOST_TEST((rows({"--energy", "e.csv", "--every", "0.1", "--trajectory", "g.csv", "--every",
                    "0.2"}) == apart));
  BOOST_TEST((rows({"--trajectory", "g.csv", "--every", "0.1", "--energy", "e.csv"}) == together));
  BOOST_TEST((rows({"--trajectory", "g.csv", "--energy", "e.csv", "--every", "0.1"}) == together));
  BOOST_TEST((rows({"--every", "0.1", "--trajectory", "g.csv", "--energy", "e.csv"}) == together));
}

BOOST_AUTO_TEST_CASE(samples_end_before_the_horizon_that_they_do_not_divide) {
  const Folder folder;
  BOOST_TEST(run("simulate", with(verlet("orbit"), {"--energy", folder / "e.csv", "--every", "0.2",
                                                    "--final", folder / "f.csv"}))
                 .status == 0);
  const Table energy = read_csv(folder / "e.csv");
  BOOST_TEST_REQUIRE(energy.rows.size() == 3u);
  BOOST_TEST(energy.value(2, "t") == 0.4);
  const Expected expected("orbit", "verlet", {.step_size = 0.001}, 0.5, {});
  check_nodes(read_csv(folder / "f.csv"), 0, 0, expected.scene, expected.states.back());
}

BOOST_AUTO_TEST_CASE(looking_at_a_run_does_not_change_where_it_ends) {
  const Folder folder;
  const std::string scene = folder.write("s.toml", triangle(3));
  for (const char* method : {"verlet", "implicit_euler", "kahan_li8"}) {
    auto arguments = verlet(scene);
    arguments[3] = method;
    run("simulate", with(arguments, {"--final", folder / "alone.csv"}));
    run("simulate",
        with(arguments, {"--final", folder / "seen.csv", "--trajectory", folder / "g.csv",
                         "--every", "0.007", "--energy", folder / "e.csv", "--every", "0.1"}));
    BOOST_TEST(read_all(folder / "alone.csv") == read_all(folder / "seen.csv"), method);
  }
}

BOOST_AUTO_TEST_CASE(every_table_has_a_sidecar_that_says_where_it_comes_from) {
  const Folder folder;
  const auto arguments =
      with(verlet("orbit"), {"--final", folder / "f.csv", "--trajectory", folder / "g.csv",
                             "--every", "0.1", "--energy", folder / "e.dat", "--every", "0.2"});
  BOOST_TEST(run("simulate", arguments).status == 0);
  BOOST_TEST(folder.listing() == "e.dat e.dat.json f.csv f.json g.csv g.json ");
  for (const char* name : {"f.json", "g.json", "e.dat.json"}) {
    const auto json = nlohmann::json::parse(read_all(folder / name));
    BOOST_TEST((json.at("command_line") == with({PROGRAM_FOLDER "/simulate"}, arguments)));
    BOOST_TEST(json.at("scene").at("hash") == content_hash(load_scene("orbit")));
    BOOST_TEST(json.at("scene").at("stiff_above").is_null());
    for (const char* key : {"version", "compiler", "flags", "cpu"}) {
      BOOST_TEST(!json.at(key).get<std::string>().empty(), key);
    }
    for (const char* library : {"eigen", "sundials", "cholmod"}) {
      BOOST_TEST(!json.at("libraries").at(library).get<std::string>().empty(), library);
    }
    const auto date = json.at("date").get<std::string>();
    BOOST_TEST((date.size() == 20 && date[4] == '-' && date[10] == 'T' && date.back() == 'Z'));
  }
}

BOOST_AUTO_TEST_CASE(the_lists_name_everything) {
  const Exit methods_text = run("simulate", {"--list-methods"});
  const Table methods_table = parse_csv(run("simulate", {"--list-methods", "--csv"}).out);
  BOOST_TEST(methods_table.rows.size() == methods().size());
  for (std::size_t i = 0; i < methods_table.rows.size(); ++i) {
    BOOST_TEST(methods_table.text(i, "name") == methods()[i].name);
    BOOST_TEST(methods_table.text(i, "source") == methods()[i].source);
    BOOST_TEST(contains(methods_text.out, {methods()[i].name, methods()[i].summary}));
  }
  const Exit scenes_text = run("simulate", {"--list-scenes"});
  const Table scenes_table = parse_csv(run("simulate", {"--csv", "--list-scenes"}).out);
  std::size_t row = 0;
  for (const Generator& generator : generators()) {
    BOOST_TEST(contains(scenes_text.out, {generator.name, generator.summary}));
    for (const GeneratorParameter& parameter : generator.parameters) {
      BOOST_TEST(scenes_table.text(row, "scene") == generator.name);
      BOOST_TEST(scenes_table.text(row, "parameter") == parameter.name);
      BOOST_TEST(scenes_table.value(row++, "standard") == parameter.standard);
    }
  }
  BOOST_TEST(scenes_table.rows.size() == row);
  BOOST_TEST((methods_text.status == 0 && scenes_text.status == 0));
}

BOOST_AUTO_TEST_CASE(negative_control_another_step_is_another_end) {
  const Folder folder;
  auto arguments = verlet("orbit");
  run("simulate", with(arguments, {"--final", folder / "a.csv"}));
  arguments[5] = "0.0010000000001";
  run("simulate", with(arguments, {"--final", folder / "b.csv"}));
  BOOST_TEST(read_all(folder / "a.csv") != read_all(folder / "b.csv"));
}

BOOST_AUTO_TEST_CASE(tolerances_that_hardly_mean_anything_are_warned_of) {
  const auto run_at = [](const char* rtol, const char* atol) {
    return run("simulate", {"--scene", "oscillator", "--method", "ida", "--until", "0.01", "--rtol",
                            rtol, "--atol", atol});
  };
  BOOST_TEST(run_at("0.1", "1e-6").err == "");
  BOOST_TEST(contains(run_at("0.2", "1e-6").err, {"simulate: warning: --rtol 0.2", "hardly"}));
  BOOST_TEST(
      contains(run_at("1e-15", "1e-6").err, {"simulate: warning: --rtol 1e-15", "rounding"}));
  BOOST_TEST(contains(run_at("1e-6", "2").err, {"simulate: warning: --atol 2", "positions, 1 m"}));
}

BOOST_AUTO_TEST_CASE(a_long_run_says_how_long_it_will_take) {
  // 2e11 steps, minutes at the very least.
  const Exit result = run("simulate", {"--scene", "pendulum", "--method", "verlet", "--step-size",
                                       "1e-11", "--time-limit", "2.5"});
  BOOST_TEST(result.status == 3);
  BOOST_TEST(contains(result.err, {"simulate: t = ", "the run will take about "}), result.err);
}

BOOST_AUTO_TEST_SUITE_END()
