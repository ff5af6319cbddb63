#include "experiments/sweep/plan.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/overwriting.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/progress.hpp"
#include "experiments/kit/shares.hpp"
#include "experiments/kit/text_hash.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {
namespace {

// What --scene takes.
std::string scene_word(const StudyScene& scene, const std::string& study_path,
                       const std::string& folder) {
  if (!scene.text.empty()) {
    require_folder(folder + "/scenes");
    // Its name holds its content, so that no earlier plan's is replaced.
    std::string path = fmt::format("{}/scenes/{}-{}.toml", folder, scene.label,
                                   text_hash(scene.text).substr(0, 8));
    WholeFile file(path);
    file.write(signed_text(scene.text));
    file.complete();
    file.commit();
    return path;
  }
  if (scene.source.empty() || find_generator(scene.source)) return scene.source;
  const auto path = std::filesystem::path(study_path).parent_path() / scene.source;
  return std::filesystem::absolute(path).lexically_normal().string();
}

// What the program takes to measure the scene by these methods; by all where there are none.
std::vector<std::string> arguments_of(const StudyFile& study, const StudyScene& scene,
                                      const std::string& scene_word,
                                      const std::vector<std::string>& methods) {
  std::vector<std::string> words;
  const auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (!scene_word.empty()) add("--scene", scene_word);
  if (scene.until > 0) add("--until", fmt::format("{}", scene.until));
  if (!study.accuracies.empty())
    add("--accuracies", fmt::format("{}", fmt::join(study.accuracies, ",")));
  if (!methods.empty()) add("--methods", fmt::format("{}", fmt::join(methods, ",")));
  for (const auto& [name, value] : study.options) {
    words.push_back("--" + name);
    if (!value.empty()) words.push_back(value);
  }
  return words;
}

// What the program says that it can measure apart: its study's key and its shares; or why it
// refuses.
struct Listed {
  std::vector<std::string> arguments;
  nlohmann::json found{};
  std::string refusal{};
};

Listed listed(const StudyFile& study, std::vector<std::string> arguments) {
  Command command{.program = program_path(study.program), .arguments = arguments};
  for (const char* word : {"--out", ".", "--list-shares", "--progress", "none"})
    command.arguments.emplace_back(word);
  const ChildEnd end = run_child(command);
  measure::stop_if_interrupted();
  Listed all{.arguments = std::move(arguments)};
  all.found = nlohmann::json::parse(end.out, nullptr, /*allow_exceptions=*/false);
  if (end.status != done || !all.found.is_object()) all.refusal = end.cause();
  return all;
}

// The shares of a scene, without those of methods that cannot run it.
Listed shares_of(const StudyFile& study, const StudyScene& scene, const std::string& scene_word) {
  Listed all = listed(study, arguments_of(study, scene, scene_word, study.methods));
  if (all.refusal.empty() || study.methods.empty()) return all;
  const Listed any = listed(study, arguments_of(study, scene, scene_word, {}));
  if (!any.refusal.empty()) return all;
  const auto shares = any.found.at("shares").get<std::vector<std::string>>();
  std::vector<std::string> fitting = study.methods;
  std::erase_if(fitting, [&](const std::string& method) {
    return std::ranges::find(shares, method) == shares.end();
  });
  if (fitting.empty() || fitting.size() == study.methods.size()) return all;
  return listed(study, arguments_of(study, scene, scene_word, fitting));
}

}  // namespace

std::vector<Task> plan(const StudyFile& study, const std::string& study_path,
                       const std::string& folder) {
  std::vector<Task> tasks;
  progress().begin(study.scenes.size());
  for (const StudyScene& scene : study.scenes) {
    progress().now_at(scene.label);
    const Listed all = shares_of(study, scene, scene_word(scene, study_path, folder));
    if (!all.refusal.empty())
      throw InvalidInput(fmt::format("{}: {}: {}", study_path, scene.label, all.refusal));
    nlohmann::json key = all.found.at("key");
    key.erase("machine");
    for (const auto& share : all.found.at("shares")) {
      tasks.push_back({.id = id_of(key, share),
                       .stage = share == reference_share ? references : points,
                       .folder = scene.label,
                       .program = study.program,
                       .share = share,
                       .arguments = all.arguments,
                       .key = key,
                       .varied = scene.varied,
                       .entry = scene.entry,
                       .order = tasks.size()});
    }
    if (tasks.size() > most_tasks) {
      throw InvalidInput(
          fmt::format("{}: its tasks are more than {}; allowed are fewer scenes or "
                      "methods",
                      study_path, most_tasks));
    }
    progress().finish(scene.label);
  }
  progress().wipe();
  return tasks;
}

}  // namespace qddot::sweep
