// SciPy's solve_ivp, in a Python process of its own for each point. scipy_peer.py reads the free
// nodes and springs from a file, times a run, and prints the end.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/bench/external_program.hpp"
#include "experiments/bench/peers.hpp"
#include "experiments/kit/program.hpp"
#include "qddot/scene/scene_file.hpp"

namespace qddot::bench {
namespace {

// Debian's own, which has SciPy; the first one on PATH may be another.
constexpr const char* python = "/usr/bin/python3";
// Python's start and its reading of the problem [s], beyond what solve_ivp may take.
constexpr double start_limit = 30;

// Nodes by their places among the free ones; pinned ends are points, numbered after these.
nlohmann::json as_json(const Problem& problem) {
  const Scene& scene = problem.start;
  const State& initial = problem.scene.initial();
  nlohmann::json json = {{"dimension", scene.dimension},
                         {"until", problem.until},
                         {"length", problem.length},
                         {"speed", problem.speed},
                         {"gravity", scene.gravity},
                         {"q", initial.q},
                         {"v", initial.v}};
  for (const char* list :
       {"mass", "load", "points", "from", "to", "stiffness", "rest_length", "quartic"}) {
    json[list] = nlohmann::json::array();
  }
  std::vector<std::size_t> place(scene.nodes.size());
  std::size_t next = 0;
  for (const bool pinned : {false, true}) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
      const Node& node = scene.nodes[i];
      if (node.pinned != pinned) continue;
      place[i] = next++;
      if (!pinned) json["mass"].push_back(node.mass);
      for (int d = 0; d < scene.dimension; ++d) {
        if (pinned)
          json["points"].push_back(node.position[d]);
        else
          json["load"].push_back(node.load[d]);
      }
    }
  }
  for (const Spring& spring : scene.springs) {
    json["from"].push_back(place[spring.nodes[0]]);
    json["to"].push_back(place[spring.nodes[1]]);
    json["stiffness"].push_back(spring.law.stiffness);
    json["rest_length"].push_back(spring.law.rest_length);
    json["quartic"].push_back(spring.law.quartic);
  }
  return json;
}

Vec vector_of(const nlohmann::json& json) {
  const auto values = json.get<std::vector<double>>();
  return Vec::Map(values.data(), std::ssize(values));
}

Run run_of(const nlohmann::json& answer, double until) {
  const std::string outcome = answer.at("outcome");
  if (outcome == name(Outcome::over_budget))
    return {.outcome = Outcome::over_budget, .seconds = answer.at("seconds")};
  if (outcome == name(Outcome::not_finite)) return {.outcome = Outcome::not_finite};
  if (outcome != name(Outcome::reached_end)) return {};
  return {.outcome = Outcome::reached_end,
          .end = {until, vector_of(answer.at("q")), vector_of(answer.at("v"))},
          .seconds = answer.at("seconds"),
          .timed = answer.at("timed"),
          .force_evaluations = answer.at("force_evaluations")};
}

class SciPy final : public Peer {
 public:
  SciPy(const std::string& method, std::string force_library)
      : Peer("SciPy " + method, Knob::rtol),
        method_(method),
        force_library_(std::move(force_library)) {}

  // Implicit methods take minutes.
  std::vector<double> values(const Problem&) const override {
    return tolerances(method_ == "DOP853" ? 2 : 1);
  }
  std::vector<ForceKind> forces() const override {
    if (force_library_.empty()) return {ForceKind::plain};
    return Peer::forces();
  }

  Run run(const Problem& problem, ForceKind force, double rtol, double limit) override {
    const ScratchFolder folder;
    std::string command =
        fmt::format("timeout {:.0f} {} {} {} {} {:.17g} {:.17g}", 2 * limit + start_limit, python,
                    kit::shell_word(SCIPY_SCRIPT),
                    kit::shell_word(folder.write("problem.json", as_json(problem).dump())), method_,
                    rtol, limit);
    if (force == ForceKind::ours) {
      command += fmt::format(" {} {}", kit::shell_word(force_library_),
                             kit::shell_word(folder.write("scene.toml", to_toml(problem.start))));
    }
    const auto [text, status] = output_of(command + " 2>/dev/null");
    if (status == timed_out) return {.outcome = Outcome::over_budget};
    const auto answer = nlohmann::json::parse(text, nullptr, false);
    return status == 0 && answer.is_object() ? run_of(answer, problem.until) : Run{};
  }

 private:
  std::string method_, force_library_;
};

}  // namespace

bool has_scipy() {
  return output_of(fmt::format("{} -c 'import scipy.integrate' 2>/dev/null", python)).second == 0;
}

std::unique_ptr<Peer> scipy(const std::string& method, const std::string& force_library) {
  return std::make_unique<SciPy>(method, force_library);
}

}  // namespace qddot::bench
