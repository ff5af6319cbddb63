#include "experiments/kit/provenance.hpp"

#include <array>
#include <fstream>
#include <unistd.h>

#include <Eigen/Core>
#include <Spectra/Util/Version.h>
#include <boost/version.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <suitesparse/cholmod.h>
#include <sundials/sundials_version.h>

#include "experiments/kit/blas.hpp"
#include "qddot/model/kernels/level.hpp"
#include "qddot/model/kernels/roots.hpp"
#include "qddot/scene/explain.hpp"
#include "qddot/scene/reduce/part.hpp"

namespace qddot::inline kit {
namespace {

std::string sundials_version() {
  std::array<char, 32> version{};
  return SUNDIALSGetVersion(version.data(), version.size()) == 0 ? version.data() : "unknown";
}

// The processor's name.
std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

std::string host() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string date_now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

nlohmann::json build() {
  return {{"code", build_info::source_hash},
          {"compiler", build_info::compiler},
          {"flags", build_info::flags}};
}

std::string_view roots() {
  return kernels::names_of_roots()[static_cast<std::size_t>(kernels::roots())];
}

nlohmann::json machine() {
  return {{"kernels", kernels::levels()[static_cast<std::size_t>(kernels::level())]},
          {"cpu", processor()},
          {"libraries",
           {{"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                                  EIGEN_MINOR_VERSION)},
            {"spectra", fmt::format("{}.{}.{}", SPECTRA_MAJOR_VERSION, SPECTRA_MINOR_VERSION,
                                    SPECTRA_PATCH_VERSION)},
            {"sundials", sundials_version()},
            {"cholmod", fmt::format("{}.{}.{}", CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION,
                                    CHOLMOD_SUBSUB_VERSION)},
            {"boost", BOOST_LIB_VERSION}}}};
}

nlohmann::json provenance(const std::vector<std::string>& command_line) {
  nlohmann::json origin = {{"command_line", command_line},
                           {"version", build_info::version},
                           {"source_hash", build_info::source_hash},
                           {"compiler", build_info::compiler},
                           {"flags", build_info::flags},
                           {"roots", roots()},
                           {"blas", blas()},
                           {"date", date_now()}};
  origin.update(machine());
  return origin;
}

nlohmann::json provenance(const std::vector<std::string>& command_line, const Scene& scene) {
  nlohmann::json origin = provenance(command_line);
  const std::vector<double> gravity(scene.gravity.begin(), scene.gravity.begin() + scene.dimension);
  const auto stiff_above = scene.stiff_above ? nlohmann::json(*scene.stiff_above) : nullptr;
  origin["scene"] = {{"name", scene.name},
                     {"hash", content_hash(scene)},
                     {"dimension", scene.dimension},
                     {"nodes", scene.nodes.size()},
                     {"springs", scene.springs.size()},
                     {"gravity", gravity},
                     {"stiff_above", stiff_above}};
  return origin;
}

nlohmann::json provenance(const std::vector<std::string>& command_line, const Scene& drawn,
                          const Scene& start, const Model& model) {
  nlohmann::json origin = provenance(command_line, drawn);
  const Explanation e = explain(start, model, at_a_glance);
  nlohmann::json reductions = nlohmann::json::array();
  for (const Finding& finding : e.findings) {
    reductions.push_back({{"name", name(finding.reduction)}, {"what", finding.what}});
  }
  // Infinite and unknown numbers become null.
  origin["reduced"] = {
      {"unknowns_drawn", e.drawn_unknowns},
      {"unknowns", e.unknowns},
      {"parts", model.parts().size()},
      {"reductions", reductions},
      {"stiffness_is_constant", e.stiffness_is_constant},
      {"omega_max", e.omega_max},
      {"omega_max_bound", e.omega_bound},
      {"largest_stable_step", 2 / e.omega_max},
      {"unstable_directions", e.is_examined ? nlohmann::json(e.unstable) : nullptr},
      {"unstable_directions_left_out", e.unstable_left_out},
      {"flat_directions", e.is_examined ? nlohmann::json(e.flat) : nullptr},
      {"flat_growth_rate_at_most", e.flat_rate},
      {"growth_rate", e.growth}};
  if (e.growth > 0) origin["reduced"]["fastest_growing_node"] = e.fastest;
  return origin;
}

}  // namespace qddot::inline kit
