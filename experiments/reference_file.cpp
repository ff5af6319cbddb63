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

bool fits(const Reference& reference, const ReducedScene& scene) {
  const Index n = scene.system().size();
  return reference.end.q.size() == n && reference.end.v.size() == n &&
         reference.certified.position > 0;
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
          {"scales",
           {{"displacement", r.scales.displacement},
            {"speed", r.scales.speed},
            {"kinetic", r.scales.kinetic}}},
          {"energy", r.energy},
          {"t", r.end.t},
          {"q", list(r.end.q)},
          {"v", list(r.end.v)}};
}

Reference reference_from_json(const nlohmann::json& json) {
  const auto& scales = json.at("scales");
  return {.end = {json.at("t"), vector(json.at("q")), vector(json.at("v"))},
          .energy = json.at("energy"),
          .scales = {scales.at("displacement"), scales.at("speed"), scales.at("kinetic")},
          .certified = {json.at("certified_position"), json.at("certified_velocity"),
                        json.at("certified_energy")},
          .rounding_effect = json.at("rounding_effect"),
          .perturbation_growth = json.at("perturbation_growth"),
          .horizon = json.at("horizon").is_null() ? std::numeric_limits<double>::infinity()
                                                  : json.at("horizon").get<double>(),
          .lyapunov = json.at("lyapunov"),
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

Reference reference_for(const Scene& drawn, const ReducedScene& scene, double until,
                        const std::string& folder, const nlohmann::json& origin,
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
                                     : make_reference(scene, until, longest_making);
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
