#include "experiments/kit/reference_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/study.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::inline kit {
namespace {

constexpr double longest_making = 60;  // [s]
// Refinement ends as soon as two methods agree; the limit is for scenes where two nearly agree.
constexpr double longest_agreeing = 300;  // [s]

constexpr const char* divisors =
    "errors of positions and velocities are divided by the largest displacement from the start [m] "
    "and the largest speed [m/s] of a node over the run, of those in the node's own part of the "
    "scene where there are several (those at rest: of the whole scene); errors of the energy by "
    "the largest kinetic energy [J]; all without what moves in closed form (nodes on no spring, "
    "the common fall of a part without pins), unless nothing else moves";

std::vector<double> list(const Vec& x) { return {x.begin(), x.end()}; }

Vec vector(const nlohmann::json& json) {
  const auto values = json.get<std::vector<double>>();
  return Eigen::Map<const Vec>(values.data(), std::ssize(values));
}

double digits(double certified) { return std::floor(-std::log10(certified) * 10) / 10; }

// The file's contents; null where there is no regular file, whatever a pipe would have to say.
nlohmann::json read_json(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return nullptr;
  std::ifstream stream(file);
  return nlohmann::json::parse(stream, nullptr, /*allow_exceptions=*/false);
}

nlohmann::json part_to_json(const PartScale& part) {
  return {{"nodes", part.nodes},
          {"extent", part.extent},
          {"displacement", part.displacement},
          {"speed", part.speed},
          {"at_rest", part.is_at_rest()}};
}

PartScale part_from_json(const nlohmann::json& json) {
  return {.nodes = json.at("nodes"),
          .extent = json.at("extent"),
          .displacement = json.at("displacement"),
          .speed = json.at("speed")};
}

nlohmann::json scales_to_json(const Scales& scales) {
  nlohmann::json json = {{"displacement", scales.displacement},
                         {"speed", scales.speed},
                         {"kinetic", scales.kinetic},
                         {"of", divisors},
                         {"parts", nlohmann::json::array()}};
  for (const PartScale& part : scales.parts) json["parts"].push_back(part_to_json(part));
  return json;
}

Scales scales_from_json(const nlohmann::json& json) {
  Scales scales{json.at("displacement"), json.at("speed"), json.at("kinetic")};
  for (const auto& part : json.at("parts")) scales.parts.push_back(part_from_json(part));
  return scales;
}

// The number of that name; `otherwise` if it is missing or null.
double number(const nlohmann::json& json, const char* name, double otherwise) {
  const auto found = json.find(name);
  return found == json.end() || found->is_null() ? otherwise : found->get<double>();
}

nlohmann::json out_of_symmetry_to_json(const Reference& reference) {
  const auto& out = reference.out_of_symmetry;
  if (!out) return nullptr;
  return {{"rounding_effect", out->effect}, {"horizon", out->horizon}, {"lyapunov", out->lyapunov}};
}

std::string written(const nlohmann::json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

// The checksum of all that is stored but itself: the hash of the compact form, in which numbers are
// exact and keys in order.
std::string checksum(nlohmann::json json) {
  json.erase("checksum");
  return text_hash(written(json, -1));
}

// Whether start and end have the same energy, as in the exact motion. The certified error and
// another machine's rounding may separate them.
bool keeps_energy(const Reference& r, const Model& scene) {
  const State& start = scene.initial();
  const double kinetic = scene.kinetic(start), potential = scene.potential(start);
  const double rounded = 64 * std::numeric_limits<double>::epsilon() *
                         (r.scales.kinetic + kinetic + std::abs(potential));
  const double tolerated = r.certified.energy * r.scales.kinetic + rounded;
  return std::abs(kinetic + potential - r.energy) <= tolerated &&
         std::abs(scene.energy(r.end) - r.energy) <= tolerated;
}

bool fits(const Reference& reference, const Model& scene, double until) {
  const Index n = scene.system().size();
  const std::size_t nodes = scene.expand(scene.initial()).size();
  return reference.end.t == until && reference.end.q.size() == n && reference.end.v.size() == n &&
         reference.certified.position > 0 &&
         std::ranges::all_of(reference.scales.parts,
                             [&](const PartScale& part) {
                               return std::ranges::all_of(part.nodes,
                                                          [&](std::size_t i) { return i < nodes; });
                             }) &&
         keeps_energy(reference, scene);
}

// The reference that the file holds, if it is whole and that of the scene at `until`.
std::optional<Reference> stored(const nlohmann::json& json, const Model& scene, double until) {
  if (!json.contains("checksum") || json["checksum"] != checksum(json)) return {};
  try {
    Reference reference = reference_from_json(json);
    if (fits(reference, scene, until)) return reference;
  } catch (const nlohmann::json::exception&) {  // written by somebody else
  }
  return {};
}

void say_expected(double seconds) {
  progress().wipe();
  fmt::print(stderr, "making the reference takes some {}\n", duration_in_words(seconds));
}

// Throws Interrupted where the program is to end: what was made meanwhile may be poorer for it.
Reference made(const Model& scene, const Scene& start, double until, std::optional<double> needed) {
  try {
    Reference reference = needed
                              ? agreed_reference(scene, until, *needed, longest_agreeing)
                              : make_reference(scene, until, longest_making, &start, say_expected);
    stop_if_interrupted();
    return reference;
  } catch (const NoReference&) {
    stop_if_interrupted();
    throw;
  }
}

std::string file_in(const std::string& folder) { return folder + "/reference.json"; }

// The key of a reference file: scene, end, code and accuracy.
nlohmann::json key_of(const Scene& drawn, const Model& scene, double until,
                      std::optional<double> needed) {
  nlohmann::json key = {{"scene_hash", content_hash(drawn)},
                        {"unknowns", scene.system().size()},
                        {"until", until},
                        {"source_hash", build_info::source_hash}};
  if (needed) key["needed"] = *needed;
  return key;
}

bool is_of(const nlohmann::json& file, const nlohmann::json& key) {
  return file.is_object() && file.value("key", nlohmann::json()) == key;
}

}  // namespace

nlohmann::json to_json(const Reference& r) {
  nlohmann::json json = {
      {"made_by", r.made_by},
      {"seconds", r.seconds},
      {"certified_position", r.certified.position},
      {"certified_velocity", r.certified.velocity},
      {"certified_energy", r.certified.energy},
      {"certified_digits",
       {{"position", digits(r.certified.position)},
        {"velocity", digits(r.certified.velocity)},
        {"energy", digits(r.certified.energy)}}},
      {"rounding_effect", r.rounding_effect},
      {"perturbation_growth", r.perturbation_growth},
      {"horizon", r.horizon},  // null where there is none
      {"lyapunov", r.lyapunov},
      {"modal_shares", list(r.modal_shares)},
      {"modal_shares_floor", r.modal_shares_floor},
      {"chaotic", r.is_chaotic()},
      {"beyond_horizon", r.is_beyond_horizon()},
      {"reduced_by_symmetry", r.is_reduced_by_symmetry},
      {"out_of_symmetry", out_of_symmetry_to_json(r)},  // null where there is none to go out of
      {"only_symmetric", r.is_only_symmetric()},
      {"scales", scales_to_json(r.scales)},
      {"energy", r.energy},
      {"t", r.end.t},
      {"q", list(r.end.q)},
      {"v", list(r.end.v)}};
  if (r.end.work.dissipated != 0) json["dissipated"] = r.end.work.dissipated;  // of damped scenes
  if (r.end.work.driven != 0) json["driven"] = r.end.work.driven;              // of driven ones
  if (r.end.phases) {
    // The numbers of broken springs (Switching).
    nlohmann::json broken = nlohmann::json::array();
    for (std::size_t k = 0; k < r.end.phases->size(); ++k) {
      if ((*r.end.phases)[k] == Phase::broken) broken.push_back(k);
    }
    json["phases"] = r.end.phases->size();
    json["broken"] = broken;
    json["released"] = r.end.work.released;
  }
  return json;
}

Reference reference_from_json(const nlohmann::json& json) {
  Reference reference = reference_without_end(json);
  reference.end = {
      json.at("t"),
      vector(json.at("q")),
      vector(json.at("v")),
      {number(json, "dissipated", 0), number(json, "driven", 0), number(json, "released", 0)}};
  if (json.contains("broken")) {
    std::vector<Phase> phases(json.at("phases"), Phase::by_length);
    for (const std::size_t k : json.at("broken")) phases.at(k) = Phase::broken;
    reference.end.phases = std::make_shared<const std::vector<Phase>>(std::move(phases));
  }
  reference.energy = json.at("energy");
  reference.scales = scales_from_json(json.at("scales"));
  reference.certified = {json.at("certified_position"), json.at("certified_velocity"),
                         json.at("certified_energy")};
  reference.rounding_effect = json.at("rounding_effect");
  reference.perturbation_growth = json.at("perturbation_growth");
  reference.made_by = json.at("made_by");
  reference.seconds = json.at("seconds");
  return reference;
}

Reference reference_without_end(const nlohmann::json& json) {
  constexpr double never = std::numeric_limits<double>::infinity();
  Reference reference;
  reference.end.t = number(json, "until", 0);
  reference.certified.position = number(json, "certified_position", 0);
  reference.rounding_effect = number(json, "rounding_effect", 0);
  reference.perturbation_growth =
      number(json, "perturbation_growth", json.value("chaotic", false) ? never : 0);
  reference.horizon = number(json, "horizon", never);
  reference.lyapunov = number(json, "lyapunov", 0);
  reference.is_reduced_by_symmetry = json.value("reduced_by_symmetry", false);
  const auto out = json.find("out_of_symmetry");
  if (out != json.end() && !out->is_null()) {
    reference.out_of_symmetry = OutOfSymmetry{.effect = number(*out, "rounding_effect", 0),
                                              .horizon = number(*out, "horizon", never),
                                              .lyapunov = number(*out, "lyapunov", 0)};
  }
  if (json.contains("modal_shares")) reference.modal_shares = vector(json["modal_shares"]);
  reference.modal_shares_floor = number(json, "modal_shares_floor", 0);
  reference.made_by = json.value("made_by", "");
  const auto scales = json.find("scales");
  if (scales != json.end() && scales->contains("displacement")) {
    reference.scales.displacement = number(*scales, "displacement", 0);
    reference.scales.speed = number(*scales, "speed", 0);
    for (const auto& part : scales->value("parts", nlohmann::json::array())) {
      const double extent = part.value("at_rest", false) ? never : 0;
      reference.scales.parts.push_back({.extent = number(part, "extent", extent),
                                        .displacement = number(part, "displacement", 0),
                                        .speed = number(part, "speed", 0)});
    }
  }
  return reference;
}

void require_reference_exists(const Model& scene, const std::string& source) {
  const auto massless = scene.massless_nodes();
  if (massless.empty()) return;
  throw InvalidInput(fmt::format(
      "{}: nodes[{}].mass: 0 is not allowed where a reference is needed, unless the node "
      "joins two springs in tension; allowed are masses above 0",
      source, massless.front()));
}

void require_reference_exists(const Subject& subject) {
  require_reference_exists(subject.model, subject.source);
}

Reference reference_for(const Subject& subject, const std::string& folder,
                        const nlohmann::json& origin) {
  return reference_for(subject.drawn, subject.start(), subject.model, subject.until, folder,
                       origin);
}

Reference reference_for(const Scene& drawn, const Scene& start, const Model& scene, double until,
                        const std::string& folder, const nlohmann::json& origin,
                        std::optional<double> needed) {
  const std::string file = file_in(folder);
  const nlohmann::json key = key_of(drawn, scene, until, needed);
  const nlohmann::json found = read_json(file);
  const bool is_own = is_of(found, key);
  if (is_own) {
    if (auto reference = stored(found, scene, until)) return *reference;
  }
  WholeFile whole(file);
  if (is_own || !(found.is_null() || found.is_object())) {
    progress().wipe();
    fmt::print(stderr,
               "{}: the file was changed or is damaged (its checksum or its numbers are wrong): "
               "the reference is made anew\n",
               in_one_line(file));
  }
  Reference reference = made(scene, start, until, needed);
  nlohmann::json json = origin;
  json.update(to_json(reference));
  json["key"] = key;
  json["scene"] = drawn.name;
  json["until"] = until;
  // Reading back turns numbers that are not finite into null, and text into valid UTF-8.
  json = nlohmann::json::parse(written(json, -1));
  json["checksum"] = checksum(json);
  whole.write(written(json, 1) + "\n");
  whole.commit();
  return reference;
}

Reference kept_reference(const Subject& subject, const std::string& folder) {
  const auto& [source, drawn, start, scene, until] = subject;
  const nlohmann::json found = read_json(file_in(folder));
  if (is_of(found, key_of(drawn, scene, until, std::nullopt))) {
    if (auto reference = stored(found, scene, until)) return *reference;
  }
  throw InvalidInput(fmt::format(
      "{}: it is missing or not the reference of this scene to {} s; the share {} makes it",
      file_in(folder), until, reference_share));
}

}  // namespace qddot::inline kit
