#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "experiments/reference.hpp"
#include "experiments/whole_file.hpp"

namespace qddot {
namespace {

std::vector<double> list(const Vec& x) { return {x.begin(), x.end()}; }

Vec vector(const nlohmann::json& json) {
  const auto values = json.get<std::vector<double>>();
  return Eigen::Map<const Vec>(values.data(), std::ssize(values));
}

double digits(double certified) { return std::floor(-std::log10(certified) * 10) / 10; }

nlohmann::json read(const std::string& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream, nullptr, /*allow_exceptions=*/false);
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
  return {
      {json.at("t"), vector(json.at("q")), vector(json.at("v"))},
      json.at("energy"),
      {scales.at("displacement"), scales.at("speed"), scales.at("kinetic")},
      {json.at("certified_position"), json.at("certified_velocity"), json.at("certified_energy")},
      json.at("made_by"),
      json.at("seconds")};
}

Reference cached_reference(const std::string& file, const nlohmann::json& key,
                           const nlohmann::json& origin, const std::function<Reference()>& make) {
  const nlohmann::json stored = read(file);
  if (stored.is_object() && stored.value("key", nlohmann::json()) == key) {
    try {
      return reference_from_json(stored);
    } catch (const nlohmann::json::exception&) {
      // A file that somebody else wrote or cut short: made anew below.
    }
  }
  const Reference reference = make();
  nlohmann::json json = origin;
  json.update(to_json(reference));
  json["key"] = key;
  WholeFile whole(file);
  whole.write(json.dump(1) + "\n");
  whole.commit();
  return reference;
}

}  // namespace qddot
