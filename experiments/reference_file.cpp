#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/provenance.hpp"
#include "experiments/reference.hpp"
#include "experiments/whole_file.hpp"
#include "src/scene/invalid_input.hpp"

namespace qddot {
namespace {

constexpr double longest_making = 60;  // [s]
// It ends as soon as two agree, so that the limit is for those that nearly do.
constexpr double longest_agreeing = 300;  // [s]

constexpr const char* divisors =
    "errors of positions and velocities are divided by the largest displacement from the start [m] "
    "and the largest speed [m/s] of a node over the run, of those in the node's own part of the "
    "scene where there are several (those at rest: of the whole scene); errors of the energy by "
    "the largest kinetic energy [J]; all without what moves in closed form (nodes on no spring, "
    "the "
    "common fall of a part without pins), unless nothing else moves";

std::vector<double> list(const Vec& x) { return {x.begin(), x.end()}; }

Vec vector(const nlohmann::json& json) {
  const auto values = json.get<std::vector<double>>();
  return Eigen::Map<const Vec>(values.data(), std::ssize(values));
}

double digits(double certified) { return std::floor(-std::log10(certified) * 10) / 10; }

nlohmann::json read(const std::string& file) {
  if (std::filesystem::is_directory(file)) return {};
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

// Infinity is null.
double time_or_never(const nlohmann::json& json) {
  return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}

nlohmann::json out_of_symmetry_to_json(const Reference& reference) {
  const auto& out = reference.out_of_symmetry;
  if (!out) return nullptr;
  return {{"rounding_effect", out->effect}, {"horizon", out->horizon}, {"lyapunov", out->lyapunov}};
}

std::optional<OutOfSymmetry> out_of_symmetry_from_json(const nlohmann::json& json) {
  if (json.is_null()) return {};
  return OutOfSymmetry{json.at("rounding_effect"), time_or_never(json.at("horizon")),
                       json.at("lyapunov")};
}

bool fits(const Reference& reference, const ReducedScene& scene) {
  const Index n = scene.system().size();
  const std::size_t nodes = scene.expand(scene.initial()).size();
  return reference.end.q.size() == n && reference.end.v.size() == n &&
         reference.certified.position > 0 &&
         std::ranges::all_of(reference.scales.parts, [&](const PartScale& part) {
           return std::ranges::all_of(part.nodes, [&](std::size_t i) { return i < nodes; });
         });
}

}  // namespace

nlohmann::json to_json(const Reference& r) {
  return {{"made_by", r.made_by},
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
}

Reference reference_from_json(const nlohmann::json& json) {
  return {.end = {json.at("t"), vector(json.at("q")), vector(json.at("v"))},
          .energy = json.at("energy"),
          .scales = scales_from_json(json.at("scales")),
          .certified = {json.at("certified_position"), json.at("certified_velocity"),
                        json.at("certified_energy")},
          .rounding_effect = json.at("rounding_effect"),
          .perturbation_growth = json.at("perturbation_growth"),
          .horizon = time_or_never(json.at("horizon")),
          .lyapunov = json.at("lyapunov"),
          .is_reduced_by_symmetry = json.at("reduced_by_symmetry"),
          .out_of_symmetry = out_of_symmetry_from_json(json.at("out_of_symmetry")),
          .modal_shares = vector(json.at("modal_shares")),
          .modal_shares_floor = json.at("modal_shares_floor"),
          .made_by = json.at("made_by"),
          .seconds = json.at("seconds")};
}

void require_reference_exists(const ReducedScene& scene, const std::string& source) {
  const auto massless = scene.massless_nodes();
  if (massless.empty()) return;
  throw InvalidInput(fmt::format(
      "{}: nodes[{}].mass: 0 is not allowed where a reference is needed, unless the node "
      "joins two springs in tension; allowed are masses above 0",
      source, massless.front()));
}

Reference reference_for(const Scene& drawn, const Scene& start, const ReducedScene& scene,
                        double until, const std::string& folder, const nlohmann::json& origin,
                        std::optional<double> needed) {
  const std::string file = folder + "/reference.json";
  nlohmann::json key = {{"scene_hash", content_hash(drawn)},
                        {"unknowns", scene.system().size()},
                        {"until", until},
                        {"source_hash", code_hash()}};
  if (needed) key["needed"] = *needed;
  const nlohmann::json stored = read(file);
  if (stored.is_object() && stored.value("key", nlohmann::json()) == key) {
    try {
      Reference reference = reference_from_json(stored);
      if (fits(reference, scene)) return reference;
    } catch (const nlohmann::json::exception&) {
      // A file that somebody else wrote or cut short: made anew below.
    }
  }
  WholeFile whole(file);
  const Reference reference = needed ? agreed_reference(scene, until, *needed, longest_agreeing)
                                     : make_reference(scene, until, longest_making, &start);
  nlohmann::json json = origin;
  json.update(to_json(reference));
  json["key"] = key;
  json["scene"] = drawn.name;
  json["until"] = until;
  whole.write(json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  whole.commit();
  return reference;
}

}  // namespace qddot
