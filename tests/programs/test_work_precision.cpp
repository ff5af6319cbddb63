#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(work_precision)

using namespace qddot;

namespace {

const std::string columns =
    "scene,method,knob,value,outcome,t_reached,error_position,error_velocity,error_energy,time_s,"
    "time_min_s,setup_s,steps,rejected,force_evaluations,stiffness_evaluations,factorizations,"
    "solves,newton_iterations";

// A finished measurement. The oscillator runs long enough for Verlet to overflow above its limit;
// short runs make first-order methods run out of time.
struct Measured {
  std::string scene, methods, until;
  Folder folder{};
  std::string out = folder / "deep/er";
  Exit result = run("work_precision", {"--scene", scene, "--until", until, "--methods", methods,
                                       "--point-limit", "0.3", "--repeats", "1", "--out", out});
  Table points = read_csv(out + "/points.csv");
  Table front = read_csv(out + "/front.csv");
  nlohmann::json reference = nlohmann::json::parse(read_all(out + "/reference.json"));

  Measured(std::string s, std::string m, std::string u) : scene(s), methods(m), until(u) {}

  bool reached(std::size_t row) const { return points.text(row, "outcome") == "reached_end"; }
};

// All measurements, made once.
const std::vector<std::unique_ptr<Measured>>& all_measured() {
  static const auto all = [] {
    std::vector<std::unique_ptr<Measured>> made;
    made.push_back(
        std::make_unique<Measured>("oscillator", "verlet,implicit_euler,arkode_dirk4", "20"));
    made.push_back(std::make_unique<Measured>("orbit", "explicit_euler,kahan_li8,ida", "0.5"));
    return made;
  }();
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_writes_its_tables_and_their_sidecars) {
  for (const auto& m : all_measured()) {
    BOOST_TEST(m->result.status == 0);
    BOOST_TEST(m->result.err == "");
    BOOST_TEST(listing(m->out) ==
               "chart.json front.csv front.json points.csv points.json reference.json ");
    BOOST_TEST(m->points.header.starts_with(columns), m->points.header);
    BOOST_TEST(m->front.header.starts_with("scene,accuracy,method,"));
    for (const char* sidecar : {"/points.json", "/front.json", "/reference.json"}) {
      const auto json = nlohmann::json::parse(read_all(m->out + sidecar));
      for (const char* key :
           {"command_line", "scene", "version", "compiler", "flags", "cpu", "libraries", "date"}) {
        BOOST_TEST(json.contains(key), sidecar << " has no " << key);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_sidecar_of_the_points_has_what_those_say_who_show_them) {
  std::size_t failures = 0;
  for (const auto& m : all_measured()) {
    const auto json = nlohmann::json::parse(read_all(m->out + "/points.json"));
    std::string met;
    for (const auto& note : json.at("methods")) {
      const Method& method = *find_method(note.at("name").get<std::string>());
      met += (met.empty() ? "" : ",") + method.name;
      BOOST_TEST(note.at("summary") == method.summary);
      const auto takes = note.at("takes").get<std::vector<std::string>>();
      const bool has_solver = std::ranges::find(takes, "--solver") != takes.end();
      BOOST_TEST(has_solver == method.listens_to(Option::solver), method.name);
    }
    BOOST_TEST(met == m->methods);
    for (std::size_t row = 0; row < m->points.rows.size(); ++row) {
      if (m->reached(row)) continue;
      ++failures;
      BOOST_TEST(!json.at("outcomes").at(m->points.text(row, "outcome")).empty());
    }
    BOOST_TEST(!json.at("outcomes").contains("reached_end"));
  }
  BOOST_TEST(failures > 0u);
}

BOOST_AUTO_TEST_CASE(each_method_has_its_points_in_the_order_asked_for) {
  for (const auto& m : all_measured()) {
    std::string met;
    for (std::size_t row = 0; row < m->points.rows.size(); ++row) {
      const std::string& name = m->points.text(row, "method");
      const Method& method = *find_method(name);
      if (!met.ends_with(name)) met += (met.empty() ? "" : ",") + name;
      BOOST_TEST(m->points.text(row, "scene") == m->scene);
      BOOST_TEST(m->points.text(row, "knob") == knob_name(method.knob));
      BOOST_TEST(m->points.value(row, "value") > 0);
      if (row > 0 && m->points.text(row - 1, "method") == name) {
        BOOST_TEST(m->points.value(row, "value") < m->points.value(row - 1, "value"));
      }
    }
    BOOST_TEST(met == m->methods);
  }
}

BOOST_AUTO_TEST_CASE(what_was_measured_is_there_and_the_rest_is_empty) {
  const std::array<const char*, 6> measured = {"error_position", "error_velocity", "error_energy",
                                               "time_s",         "time_min_s",     "setup_s"};
  std::vector<std::string> outcomes;
  for (const auto& m : all_measured()) {
    const double until = number(m->until);
    for (std::size_t row = 0; row < m->points.rows.size(); ++row) {
      outcomes.push_back(m->points.text(row, "outcome"));
      for (const char* column : measured) {
        if (m->reached(row)) {
          BOOST_TEST(m->points.value(row, column) >= 0);
        } else {
          BOOST_TEST(m->points.text(row, column) == "");
        }
      }
      if (m->reached(row)) {
        BOOST_TEST(m->points.value(row, "t_reached") == until);
        BOOST_TEST(m->points.value(row, "steps") > 0);
        BOOST_TEST(m->points.value(row, "time_min_s") > 0);
        BOOST_TEST(m->points.value(row, "time_min_s") <= m->points.value(row, "time_s"));
      } else {
        BOOST_TEST(m->points.value(row, "t_reached") < until);
      }
    }
  }
  for (const char* outcome : {"reached_end", "diverged", "over_budget"}) {
    BOOST_TEST(std::ranges::count(outcomes, outcome) > 0, outcome);
  }
}

BOOST_AUTO_TEST_CASE(the_largest_energy_error_on_the_way_is_no_less_than_that_at_the_end) {
  for (const auto& m : all_measured()) {
    bool is_more = false;
    for (std::size_t row = 0; row < m->points.rows.size(); ++row) {
      if (!m->reached(row)) continue;
      const double at_end = m->points.value(row, "error_energy");
      BOOST_TEST(m->points.value(row, "error_energy_max") >= at_end);
      is_more |= m->points.value(row, "error_energy_max") > 2 * at_end;
      // The orbit turns about its pin; the oscillator has nothing that turns.
      BOOST_TEST((m->points.text(row, "error_momentum_max") == "") == (m->scene == "oscillator"));
      BOOST_TEST(m->points.text(row, "error_modal_shares") == "");
    }
    BOOST_TEST(is_more, m->scene);
  }
}

BOOST_AUTO_TEST_CASE(what_is_known_of_an_error_is_within_what_is_certified) {
  for (const auto& m : all_measured()) {
    const double certified = m->reference.at("certified_position");
    for (std::size_t row = 0; row < m->points.rows.size(); ++row) {
      if (!m->reached(row)) continue;
      const double error = m->points.value(row, "error_position");
      BOOST_TEST(m->points.value(row, "error_position_at_most") == error + certified);
      BOOST_TEST(m->points.value(row, "error_position_at_least") ==
                 std::max(error - certified, 0.0));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_motion_in_exact_symmetry_is_told_and_judged_by_its_positions) {
  const Folder folder;
  const std::string scene = folder.write("strut.toml", R"(
dimension = 2
until = 0.7
nodes = [
  { position = [0.0, 0.0], mass = 1.0, pinned = true },
  { position = [0.9, 0.0], velocity = [0.1, 0.0], mass = 0.1 },
  { position = [1.8, 0.0], velocity = [-0.2, 0.0], mass = 0.1 },
  { position = [2.7, 0.0], mass = 1.0, pinned = true },
]
springs = [
  { nodes = [0, 1], stiffness = 1000.0, rest_length = 1.0 },
  { nodes = [1, 2], stiffness = 1000.0, rest_length = 1.0 },
  { nodes = [2, 3], stiffness = 1000.0, rest_length = 1.0 },
]
)");
  const Exit result = run("work_precision", {"--scene", scene, "--methods", "blanes_moan6",
                                             "--repeats", "1", "--out", folder / "out"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(contains(result.out, {"exists only in exact symmetry", "divided by the largest"}));
  const auto reference = nlohmann::json::parse(read_all(folder / "out/reference.json"));
  BOOST_TEST(reference.at("only_symmetric") == true);
  BOOST_TEST(reference.at("beyond_horizon") == false);
  BOOST_TEST(reference.at("out_of_symmetry").at("horizon") < 0.7);
  const Table front = read_csv(folder / "out/front.csv");
  BOOST_TEST(front.text(3, "judged_by") == "position");
  BOOST_TEST(front.text(3, "method") == "blanes_moan6");
}

BOOST_AUTO_TEST_CASE(beyond_the_horizon_the_tables_and_words_say_so) {
  const Folder folder;
  const std::string scene = folder.write(
      "chain.toml", "until = 12\n[generator]\nkind = \"chain\"\nnodes = 4\nstiffness = 1000\n");
  const Exit result =
      run("work_precision", {"--scene", scene, "--methods", "blanes_moan6", "--point-limit", "20",
                             "--repeats", "1", "--out", folder / "out"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(
      contains(result.out, {"chaotic", "Lyapunov", "Position errors at the end mean nothing"}));
  const auto reference = nlohmann::json::parse(read_all(folder / "out/reference.json"));
  BOOST_TEST(reference.at("beyond_horizon") == true);
  BOOST_TEST((reference.at("horizon") > 6 && reference.at("horizon") < 12));
  BOOST_TEST(reference.at("lyapunov") > 1);
  const Table points = read_csv(folder / "out/points.csv"),
              front = read_csv(folder / "out/front.csv");
  const std::size_t last = points.rows.size() - 1;
  BOOST_TEST(points.value(last, "error_energy_max") < 1e-6);
  BOOST_TEST(points.value(last, "error_position") > 1e-2);
  BOOST_TEST(points.value(last, "error_modal_shares") < 1);
  BOOST_TEST(front.text(3, "judged_by") == "energy");
  BOOST_TEST(front.text(3, "method") == "blanes_moan6");
}

BOOST_AUTO_TEST_CASE(every_number_in_the_tables_is_finite) {
  for (const auto& m : all_measured()) {
    for (const Table* table : {&m->points, &m->front}) {
      for (const auto& row : table->rows) {
        for (const std::string& field : row) {
          BOOST_TEST((field != "nan" && field != "inf" && field != "-nan" && field != "-inf"));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(errors_are_those_of_the_closed_form) {
  const Measured& m = *all_measured()[0];
  const ReducedScene scene(load_scene("oscillator"));
  int compared = 0;
  for (std::size_t row = 0; row < m.points.rows.size(); ++row) {
    if (m.points.text(row, "method") != "verlet" || !m.reached(row)) continue;
    State state = scene.initial();
    make_integrator(*find_method("verlet"), scene.system(),
                    {.step_size = m.points.value(row, "value")})
        ->advance(state, 20);
    // x = cos 10 t, which is up to 2 m away from where it starts.
    const double error = std::abs(state.q[0] - std::cos(200.0)) / 2;
    BOOST_TEST(std::abs(m.points.value(row, "error_position") - error) < 1e-3 * error + 1e-13);
    ++compared;
  }
  BOOST_TEST(compared > 3);
}

BOOST_AUTO_TEST_CASE(the_reference_says_how_it_was_made_and_how_far_it_holds) {
  for (const auto& m : all_measured()) {
    for (const char* part : {"position", "velocity", "energy"}) {
      const double certified = m->reference.at(fmt::format("certified_{}", part));
      const double digits = m->reference.at("certified_digits").at(part);
      BOOST_TEST((certified > 0 && certified < 1e-11));
      BOOST_TEST(std::abs(digits + std::log10(certified)) < 0.11);
    }
    BOOST_TEST(contains(m->reference.at("made_by").get<std::string>(), {"kahan_li8", ";"}));
    BOOST_TEST(m->reference.at("t") == number(m->until));
    BOOST_TEST(m->reference.at("q").size() == (m->scene == "orbit" ? 2u : 1u));
    BOOST_TEST(m->reference.at("seconds") > 0);
  }
}

BOOST_AUTO_TEST_CASE(no_method_goes_beyond_the_finest_accuracy_that_is_asked_for) {
  const Folder folder;
  BOOST_TEST(
      run("work_precision", {"--scene", "pendulum", "--until", "0.5", "--methods",
                             "rk4,trapezoidal,ida", "--accuracies", "1e-4,1e-2", "--point-limit",
                             "0.1", "--repeats", "1", "--out", folder.path()})
          .status == 0);
  const Table points = read_csv(folder / "points.csv"), front = read_csv(folder / "front.csv");
  std::map<std::string, int> fine, fine_before_last;
  for (std::size_t row = 0; row < points.rows.size(); ++row) {
    if (points.text(row, "outcome") != "reached_end") continue;
    const std::string method = points.text(row, "method");
    fine_before_last[method] = fine[method];
    fine[method] += points.value(row, "error_position_at_most") <= 1e-4;
  }
  for (const char* method : {"trapezoidal", "ida"}) {
    BOOST_TEST(fine.at(method) == 1, method);
    BOOST_TEST(fine_before_last.at(method) == 0, method);
  }
  // Near its limit of stability steps are taken closer, up to the first that will do.
  BOOST_TEST(fine.at("rk4") >= 1);
  BOOST_TEST_REQUIRE(front.rows.size() == 2u);
  BOOST_TEST(front.value(0, "accuracy") == 1e-2);
  BOOST_TEST(front.value(1, "accuracy") == 1e-4);
}

BOOST_AUTO_TEST_SUITE_END()
