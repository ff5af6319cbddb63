#include "experiments/sweep/plan.hpp"

#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/command/overwriting.hpp"
#include "experiments/command/program.hpp"
#include "experiments/command/progress.hpp"
#include "experiments/command/shares.hpp"
#include "experiments/command/whole_file.hpp"
#include "qddot/measure/motion/interruption.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::sweep {

using namespace command;
namespace {

// What --scene takes.
std::string scene_word(const StudyScene& scene, const std::string& study_path,
                       const std::string& folder) {
  if (!scene.text.empty()) {
    require_folder(folder + "/scenes");
    // By its content, so that no earlier plan's is replaced.
    const std::string path =
        fmt::format("{}/scenes/{}-{}.toml", folder, scene.label, hash_of(scene.text).substr(0, 8));
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

std::vector<std::string> arguments_of(const StudyFile& study, const StudyScene& scene,
                                      const std::string& scene_word) {
  std::vector<std::string> words;
  if (!scene_word.empty()) words.insert(words.end(), {"--scene", scene_word});
  if (scene.until > 0) words.insert(words.end(), {"--until", fmt::format("{}", scene.until)});
  if (!study.accuracies.empty())
    words.insert(words.end(),
                 {"--accuracies", fmt::format("{}", fmt::join(study.accuracies, ","))});
  if (!study.methods.empty())
    words.insert(words.end(), {"--methods", fmt::format("{}", fmt::join(study.methods, ","))});
  for (const auto& [name, value] : study.options) {
    words.push_back("--" + name);
    if (!value.empty()) words.push_back(value);
  }
  return words;
}

// What the program can measure apart: its study's key and its shares.
nlohmann::json listed(const StudyFile& study, const StudyScene& scene,
                      const std::vector<std::string>& arguments, const std::string& study_path) {
  Command command{.program = program_path(study.program), .arguments = arguments};
  const auto add = [&](std::initializer_list<std::string> words) {
    command.arguments.insert(command.arguments.end(), words);
  };
  add({"--out", ".", "--list-shares", "--progress", "none"});
  const ChildEnd end = run_child(command);
  measure::stop_if_interrupted();
  const auto json = nlohmann::json::parse(end.out, nullptr, /*allow_exceptions=*/false);
  if (end.status == done && json.is_object()) return json;
  throw InvalidInput(fmt::format("{}: {}: {}", study_path, scene.label, end.cause()));
}

}  // namespace

std::vector<Task> plan(const StudyFile& study, const std::string& study_path,
                       const std::string& folder) {
  std::vector<Task> tasks;
  progress().begin(study.scenes.size());
  for (const StudyScene& scene : study.scenes) {
    progress().now_at(scene.label);
    const auto arguments = arguments_of(study, scene, scene_word(scene, study_path, folder));
    const nlohmann::json found = listed(study, scene, arguments, study_path);
    for (const auto& share : found.at("shares")) {
      Task task{.id = id_of(found.at("key"), share),
                .stage = share == reference_share ? references : points,
                .folder = scene.label,
                .program = study.program,
                .share = share,
                .arguments = arguments,
                .key = found.at("key"),
                .varied = scene.varied,
                .entry = scene.entry,
                .order = tasks.size()};
      task.key.erase("machine");
      tasks.push_back(std::move(task));
    }
    if (tasks.size() > most_tasks) {
      throw InvalidInput(
          fmt::format("the study has more than {} tasks; allowed are fewer scenes or "
                      "methods",
                      most_tasks));
    }
    progress().finish(scene.label);
  }
  progress().wipe();
  return tasks;
}

}  // namespace qddot::sweep
